#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blind/protocol.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace blind {

/// How the room's temperature changes during a campaign.
struct RoomPlan {
  double base = 22;            ///< at the start [degree Celsius]
  double drift = 0;            ///< change from start to end, or height of the swing or step [K]
  std::string shape;           ///< ramp, warm_up, swing or step
  double ripple = 0.1;         ///< amplitude of a fast ripple beside it [K]
  double ripple_period = 600;  ///< [s]

  double at(double share, double time) const;  ///< `share` of the campaign's duration; `time` [s]
};

/// The chamber's transducer, its converter and the program that records them.
struct ReferencePlan {
  double rate = 10;     ///< samples a second
  double averaged = 0;  ///< width of the centred average that the converter's driver forms [s]
  double noise = 0;     ///< of one sample before that average [share of the highest pressure]
  double offset = 0;    ///< [share of the highest pressure]
  double slope = 0;     ///< error of the span, relative
  double bend = 0;      ///< [share of the highest pressure]
  int bits = 14;        ///< of its converter, over 1.6 times the highest pressure
};

/// Which scans end up in which bag.
struct CutPlan {
  std::string kind;         ///< by_surface, joined or odd_places
  double lost = 0;          ///< share of scans that are lost
  std::size_t longest = 1;  ///< longest run of lost scans
};

/// Everything about a case that is decided before anything is hidden in it. Pressures are reduced: 620 kPa
/// stand for the highest pressure of the protocol, `peak`.
struct RigPlan {
  std::string protocol_class;
  fsr::matrix::MatrixSize matrix;
  double pitch = 0.01;        ///< distance of neighbouring taxels [m]
  double scan_rate = 10;      ///< [Hz]
  int bits = 12;              ///< of the matrix's converter
  double peak = kPeak;        ///< highest gauge pressure [Pa]
  double valve_lag = 0.3;     ///< time constant with which valve and hoses smooth the set pressure [s]
  std::vector<int> radii;     ///< of the surfaces [mm]; 0 = flat, always the first one
  std::vector<double> reach;  ///< highest pressure on each surface, share of `peak`
  std::vector<PlannedVisit> visits;
  RoomPlan room;
  bool thermometer = true;
  ReferencePlan reference;
  CutPlan cut;

  std::size_t mounts = 1;    ///< largest number of mounts of one surface
  std::size_t cycles = 0;    ///< of all visits
  double fastest = 0;        ///< shortest time of a ramp over the whole range [s]
  double slowest = 0;        ///< longest one [s]
  bool exponential = false;  ///< filling and venting approach their target exponentially

  double duration() const;  ///< recorded [s]
  double readings() const;  ///< scans x taxels
  /// Whether the ramps have one pace: nothing then separates a loop from a short memory.
  bool onePace() const { return slowest < 1.5 * fastest; }
};

/// The classes of protocols:
///
///     regular          equal cycles at one pace, as in the paper
///     hand_run         peak, pace, dwell and rest differ from cycle to cycle
///     partial_loops    smaller loops within the cycles
///     dwells           stays of several lengths at several pressures, several paces
///     one_pace         peaks differ, the pace of the straight ramps does not
///     uneven_surfaces  each surface has its own highest pressure
///     many_mounts      two or three mounts of every surface
///     short            one or two surfaces, four to six cycles each
const std::vector<std::string>& protocolClasses();

/// Most readings of a case of the sizes `small` and `full`.
constexpr double kSmallReadings = 600e3, kFullReadings = 3e6;

/// Draws the plan of a case from the hash of its name; nothing that is hidden has a part in it.
/// `protocol_class` is drawn too where it is empty. Throws fsr::InputError where there is no such class.
RigPlan drawPlan(std::uint64_t name_hash, const std::string& protocol_class, double most_readings);

}  // namespace blind
