#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "blind/random.h"

namespace blind {

constexpr double kPeak = 620e3;  ///< highest gauge pressure of the protocols [Pa]

/// Set pressure of the chamber while the matrix lies on one surface: gauge pressure [Pa] at times [s] from
/// the first scan, linear between them.
struct ChamberPath {
  std::vector<double> time;
  std::vector<double> pressure;
  std::vector<double> cycle_start;  ///< [s]

  double duration() const { return time.back(); }
};

/// One stay of the matrix on a surface.
struct PlannedVisit {
  std::size_t surface = 0;  ///< index into the campaign's surfaces; 0 = flat
  ChamberPath path;
  double ambient_step = 0;  ///< room temperature relative to the usual one of the campaign [K]
  double pause = 300;       ///< time without pressure before the first scan, for mounting [s]
};

/// How much of a protocol is recorded.
struct ProtocolSize {
  std::size_t surfaces = 6;
  double cycles = 1;  ///< share of the full number of cycles on each surface
};

/// Protocols by name:
///
///     paper            10 cycles at 17 kPa/s on each surface
///     paper_remounted  5 such cycles on each surface, then all surfaces again in another order
///     two_speeds       cycles at 8 and at 40 kPa/s, with dwells at half and full pressure
///     minor_loops      loops within loops, of four depths
///     step_hold        steps to half and full pressure, each held for 300 s, with rests
///     rest             200 s without load before and after the cycles
///     two_ambients     5 cycles on each surface, then all surfaces again in a room 8 to 12 K warmer
///     random_order     two speeds, surfaces in random order, each mounted again, the flat one at the end
///     hours_apart      6 to 60 fast cycles on the flat surface, five times within eight hours, once in a
///                      warmer room
const std::vector<std::string>& protocolNames();
/// Whether the protocol mounts the matrix on one surface more than once.
bool remounts(const std::string& protocol);

/// Throws fsr::InputError where the name is unknown.
std::vector<PlannedVisit> planVisits(const std::string& protocol, const ProtocolSize& size, Random random);

}  // namespace blind
