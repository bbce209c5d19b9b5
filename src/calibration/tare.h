#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr::calibration {

/// What a calibration reads of an unloaded sheet: an offset of each taxel, taken off after the table. It
/// holds for one calibration, surface and mount, and dies with any of them.
struct Tare {
  std::string calibration;  ///< id of the calibration
  std::string surface;      ///< name of the surface; may be empty
  std::uint32_t mount = 0;  ///< 0 = unknown
  double curvature = 0;     ///< principal, mean over the taxels [1/m]
  std::string date;         ///< ISO 8601, UTC
  matrix::MatrixSize size;
  std::vector<float> offset;  ///< [rows x columns], row-major [Pa]
};

/// A surface whose mean curvature differs by more is another one, whatever its name says [1/m].
constexpr double kTareCurvatureTolerance = 0.5;

/// Whether a tare still holds.
bool holds(const Tare& tare, const std::string& calibration, const matrix::Surface& surface);

/// Mean principal curvature [1/m]; 0 where unknown.
double meanCurvature(const matrix::Surface& surface);

/// When a tare is refused.
struct TareOptions {
  double limit = 30e3;           ///< largest offset of a taxel: beyond, something presses [Pa]
  double scatter = 3e3;          ///< largest standard deviation of a taxel: a limb never keeps still [Pa]
  double window = 2.0;           ///< span of scans that is averaged [s]
  std::size_t least_scans = 10;  ///< a window with fewer lasts on
};

/// Gathers maps of the sheet at rest and judges whether their mean may be taken off. The maps may carry
/// a tare: what is measured is what has to be added to it.
class TareMeasurement {
 public:
  TareMeasurement(const matrix::Layout& layout, const TareOptions& options);

  /// Takes a map; `time` is its stamp [s]. True once the window is full. Time that runs back starts anew.
  bool add(const map::PressureMap& map, double time) noexcept;

  /// `standing` (the tare that the maps carried, empty = none) plus the mean of each taxel [rows x
  /// columns] [Pa]; taxels without a reading keep theirs. Throws InputError where the sum is beyond
  /// TareOptions::limit or the readings scatter, naming the taxel, or where no taxel had a reading.
  std::vector<float> offset(const std::vector<float>& standing) const;

 private:
  /// Running mean and sum of squared differences (Welford 1962).
  struct Moments {
    double count = 0;
    double mean = 0;     // [Pa]
    double squares = 0;  // [Pa^2]
  };

  std::string place(std::size_t taxel) const;

  matrix::Layout layout_;
  TareOptions options_;
  std::vector<Moments> moments_;  // [taxels]
  std::size_t scans_ = 0;
  double start_ = 0;  // [s]
};

/// A tare's file: YAML, written whole or not at all. Throws InputError.
void saveTare(const Tare& tare, const std::string& path);

/// Reads it strictly. Throws InputError.
Tare loadTare(const std::string& path);

}  // namespace fsr::calibration
