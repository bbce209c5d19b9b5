#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "statistics/samples.h"

namespace fsr::calibration {

/// An offset for each taxel, subtracted after the table: by how much the pressure that a calibration reads on
/// an unloaded sheet has changed since its training. It is valid for one calibration, surface and mount.
struct Tare {
  std::string calibration;  ///< id of the calibration
  std::string surface;      ///< name of the surface; may be empty
  std::uint32_t mount = 0;  ///< 0 = unknown
  double curvature = 0;     ///< principal, mean over the taxels [1/m]
  std::string date;         ///< ISO 8601, UTC
  matrix::MatrixSize size;
  std::vector<float> offset;  ///< [rows x columns], row-major [Pa]
};

/// A surface whose mean curvature differs by more than this is another surface, whatever its name [1/m].
constexpr double kTareCurvatureTolerance = 0.5;

/// Whether a tare is valid.
bool holds(const Tare& tare, const std::string& calibration, const matrix::Surface& surface);

/// Mean principal curvature [1/m]; 0 if unknown.
double meanCurvature(const matrix::Surface& surface);

/// What the tables answer too much at the rests of their training, of the class that `calibrator` has chosen
/// for each taxel [taxels] [Pa].
std::vector<float> restOfTraining(const SessionZero& zero, const Calibrator& calibrator);

/// Limits of a tare.
struct TareOptions {
  double limit = 30e3;   ///< largest offset of a taxel: a larger one means that something presses on it [Pa]
  double scatter = 3e3;  ///< largest standard deviation of a taxel: a limb is never still [Pa]
  double window = 2.0;   ///< duration over which scans are averaged [s]
  std::size_t least_scans = 10;  ///< a window with fewer scans is extended
};

/// Collects maps of the sheet at rest and judges whether their mean may be subtracted. The maps may include a
/// tare; then the result is to be added to it.
class TareMeasurement {
 public:
  TareMeasurement(const matrix::Layout& layout, const TareOptions& options);

  /// Adds a map; `time` is its stamp [s]. True once the window is full. If time runs backwards, the window
  /// starts again.
  bool add(const map::PressureMap& map, double time) noexcept;

  /// `standing` (the tare that the maps include, empty = none) plus the mean of each taxel minus that of
  /// `training` (as restOfTraining(); empty = 0) [rows x columns] [Pa]. Taxels without a reading keep their
  /// value of `standing`. Throws InputError that names the taxel if the sum exceeds TareOptions::limit or the
  /// readings scatter too much, and if no taxel had a reading.
  std::vector<float> offset(const std::vector<float>& standing,
                            const std::vector<float>& training = {}) const;

 private:
  std::string place(std::size_t taxel) const;

  matrix::Layout layout_;
  TareOptions options_;
  std::vector<statistics::RunningMoments> moments_;  // [taxels], of pressures [Pa]
  std::size_t scans_ = 0;
  double start_ = 0;  // [s]
};

/// Writes a tare as YAML, so that the file is complete or unchanged. Throws InputError.
void saveTare(const Tare& tare, const std::string& path);

/// Reads such a file. Throws InputError if a key is unknown, missing or out of range.
Tare loadTare(const std::string& path);

/// Throws InputError if there is something else than a tare at `path`: it may be neither replaced nor
/// removed. A tare that was damaged behind its first line is a tare.
void requireTareOrNothing(const std::string& path);

/// The offset of each taxel that a tare at the start of a session measures [Pa]: what a live map without tare
/// and memory shows too much over restAtStart(), beyond what it showed so at the rests of the training. Empty
/// where the calibration expects no tare or the session does not start with a rest. `condition`: of the
/// recording.
std::vector<float> tareAtStart(const Calibration& calibration, const dataset::Recording& recording,
                               std::size_t condition);

}  // namespace fsr::calibration
