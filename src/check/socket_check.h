#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::check {

/// A part of the recording without load, with the readings of the taxels in it.
struct SocketRest {
  double from = 0, to = 0;       ///< [s] since the first scan
  std::vector<double> readings;  ///< mean of each taxel [share of full scale], row-major
};

/// The longest time between putting on and taking off for which a taxel carried a nearly constant load.
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
  std::size_t changed = 0;  ///< number of taxels that changed by more than is allowed
  /// Median over taxels of the change by the calibration [Pa].
  double median_pressure_change = std::numeric_limits<double>::quiet_NaN();
  double saturated = 0;                                           ///< readings at full scale (ratio)
  double beyond = std::numeric_limits<double>::quiet_NaN();       ///< codes outside of training (ratio)
  double bent_beyond = std::numeric_limits<double>::quiet_NaN();  ///< curvature outside of training (ratio)
  StaticLoad longest;
  std::vector<std::size_t> dead, stuck;
  std::vector<std::string> reasons;  ///< why the recording should be examined, worst first
};

/// When the socket was put on and taken off [s] since the first scan, if events say so.
struct DonDoff {
  std::optional<double> don, doff;
};

/// Judges a recording without a reference by its own readings: rest before and after, share of readings that
/// are not measurements, duration of constant loads. It does not judge accuracy. `calibration` may be null;
/// then the share of readings outside the range of training is unknown. Throws InputError if the calibration
/// is of another matrix.
SocketCheck checkSocket(const dataset::Recording& recording, const DonDoff& events,
                        const calibration::Calibration* calibration);

}  // namespace fsr::check
