#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::life {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A sheet on one surface. NaN = not known.
struct SurfaceState {
  std::string surface;
  /// Slope of what the first calibration answers over the true pressure: mean of the taxels, and their
  /// standard deviation (ratio). 1.1 = the sheet reads 10 % more than on the date of the first calibration.
  double gain = kUnknown;
  double gain_scatter = kUnknown;
  double zero = kUnknown;   ///< reading of the sheet at rest, mean of the taxels [counts]
  double noise = kUnknown;  ///< standard deviation of a taxel's reading at rest, from one scan to the next
                            ///< [counts]
};

/// The share of the first calibration's range of pressure over which the slope is taken. The rest of the
/// range is left to a sheet whose gain rises: up to 1 / 0.7 = 1.4 times its first gain it still reads codes
/// that the first calibration knows. Below, preload and turn-on pressure bend the curve.
constexpr double kLowShare = 0.1;
constexpr double kHighShare = 0.7;

/// What one recording or one calibration tells about its sheet.
struct SheetState {
  enum class Source { kRecording, kCalibration };
  Source source = Source::kRecording;
  std::string file;  ///< as the user shall read it
  std::string sheet;
  std::int64_t date_ns = 0;  ///< since 1970, UTC [ns]
  matrix::Layout layout;
  std::uint16_t full_scale = 0;
  std::vector<SurfaceState> surfaces;    ///< in the order of their first appearance
  std::vector<std::size_t> dead, stuck;  ///< taxels; of a calibration: dead = those without a model
  double temperature = kUnknown;         ///< mean [degree Celsius]
  double error = kUnknown;               ///< of a calibration: RMSE on held-out readings [Pa]
};

/// Mean of the values that are known; kUnknown where none is.
double meanOfKnown(const std::vector<double>& values);

/// The name of a sheet: its serial number, else its sensor id, else "". Sheets of different names are never
/// mixed.
std::string sheetOf(const dataset::SensorIdentity& sensor);

/// What a recording tells. `first`: the first calibration of the sheet; null = there is none, and the gain is
/// not known. It is not known either on surfaces that `first` was not trained on. Zero and noise are those of
/// the rest at the start (calibration::restAtStart()); readings up to five deviations of this noise count as
/// dead. Taxels that are dead or stuck do not count in the gain. Without a chamber pressure only taxels and
/// temperature are known. Throws InputError where `first` is of another matrix or converter.
SheetState stateOf(const dataset::Recording& recording, const calibration::Calibration* first);

/// What a calibration tells. Throws InputError where `first` is of another matrix or converter, and where the
/// date of the calibration is none.
SheetState stateOf(const calibration::Calibration& calibration, const calibration::Calibration* first);

/// Nanoseconds since 1970 of a date such as 2026-03-01T12:00:00Z. Throws InputError.
std::int64_t dateOf(const std::string& iso);
/// "2026-03-01", UTC.
std::string dayText(std::int64_t date_ns);

}  // namespace fsr::life
