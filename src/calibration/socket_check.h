#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// When a recording in a socket is to be looked at again; every default stands here.
struct SocketCheckOptions {
  double rest_time = 2.0;         ///< shortest rest before and after [s]
  double rest_share = 0.25;       ///< a rest reads no more than this share of the usual load (ratio)
  double rest_change = 0.02;      ///< of a taxel from rest before to rest after [share of full scale]
  double changed_share = 0.05;    ///< taxels that may change by more (ratio)
  double saturated_share = 0.01;  ///< readings at full scale (ratio)
  double beyond_share = 0.05;     ///< readings outside of training (ratio)
  double contact_share = 0.10;    ///< from here on a taxel is loaded [share of full scale]
  double static_range = 0.20;     ///< a load is static while its reading ranges over less, of itself (ratio)
  double static_load = 300;       ///< longest static load before creep is to be thought of [s]
};

/// A stretch of the recording without load, and what the taxels read in it.
struct SocketRest {
  double from = 0, to = 0;       ///< [s] since the first scan
  std::vector<double> readings;  ///< mean of each taxel [share of full scale], row-major
  std::vector<double> pressure;  ///< likewise by the calibration [Pa]; empty = none given; NaN = no reading
};

/// Longest time that one taxel carried a load that hardly changed.
struct StaticLoad {
  double seconds = 0;
  double from = 0;  ///< [s] since the first scan
  std::size_t taxel = 0;
};

struct SocketCheck {
  std::string name;
  matrix::Layout layout;
  std::optional<SocketRest> before, after;
  std::vector<double> change;  ///< after - before [share of full scale], row-major; empty = unknown
  double median_change = std::numeric_limits<double>::quiet_NaN();  ///< [share of full scale]
  std::size_t worst = 0;                                            ///< taxel of the largest change
  std::size_t changed = 0;  ///< taxels that changed by more than is allowed
  /// Median over taxels of the change by the calibration [Pa].
  double median_pressure_change = std::numeric_limits<double>::quiet_NaN();
  double saturated = 0;                                           ///< readings at full scale (ratio)
  double beyond = std::numeric_limits<double>::quiet_NaN();       ///< codes outside of training (ratio)
  double bent_beyond = std::numeric_limits<double>::quiet_NaN();  ///< curvature outside of training (ratio)
  StaticLoad longest;
  std::vector<std::size_t> dead, stuck;
  std::vector<std::string> reasons;  ///< why to look again, worst first
};

/// When the socket was put on and taken off [s] since the first scan, where events say so.
struct DonDoff {
  std::optional<double> don, doff;
};

/// Judges a recording that has no reference by what it says of itself: rest before and after, shares of
/// readings that are no measurement, how long loads stood still. It says nothing of accuracy. `calibration`
/// may be null: then what lies beyond training is not known. Throws InputError where it is of another matrix.
SocketCheck checkSocket(const dataset::Recording& recording, const DonDoff& events,
                        const Calibration* calibration, const SocketCheckOptions& options = {});

}  // namespace fsr::calibration
