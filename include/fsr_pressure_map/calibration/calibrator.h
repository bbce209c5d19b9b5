#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/history.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/health/taxel_watch.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/matrix/scan.h"

namespace fsr::calibration {

/// The user's options for live calibration, with all defaults.
struct CalibratorOptions {
  double class_hysteresis =
      0.5;  ///< a taxel changes its class only if another is nearer by more than this [1/m]
  double curvature_timeout = 0;  ///< a surface older than this is stale [s]; 0 = never
  /// A taxel's blended table is computed again when its curvature has changed by more than this [1/m].
  double curvature_step = 0.02;
  /// Temperatures up to this far outside those of training are not flagged [K]. FSRs change by about 0.3 % a
  /// kelvin.
  double temperature_margin = 5;
  bool fill_bad_taxels = false;  ///< give dead and stuck taxels the mean of their neighbours, flagged
  health::TaxelWatchOptions watch;
};

/// The curvature class in use at a taxel.
struct ClassChoice {
  std::size_t curvature_class = 0;
  std::uint16_t flags = 0;  ///< taxel_flag::kCurvatureExtrapolated, kBetweenClasses or 0
};

/// Converts scans to pressure maps, with one table look-up for each taxel, whatever the scheme. For a surface
/// without a table of its own, setSurface() computes one table for each taxel from those of the calibration.
///
/// The calibrator keeps the state of the live path: the surface, the class of each taxel, mask, tare, and the
/// watch for dead and stuck taxels.
///
/// Flags of a taxel:
///   kSaturated              code at full scale: the pressure is a lower limit
///   kReadingExtrapolated    code outside the codes of training, low or high; between two classes above the
///                           highest code of either
///   kBelowRange             code 0, no conductance: every pressure below the turn-on pressure reads so, and
///   the
///                           pressure is an upper limit; likewise a code below those of training, e.g. of a
///                           taxel at rest beside a load
///   kCurvatureExtrapolated  curvature outside the range of training; if training had one surface only, the
///                           deviation is NaN, because it is unknown
///   kBetweenClasses         curvature farther than the class tolerance from the class in use
///   kTemperatureExtrapolated  temperature outside the range of training by more than temperature_margin
///   kDead, kStuck           see TaxelWatch; no reading (NaN) unless filled (kFilled)
///   kMasked                 masked, or without a model: no reading, and never filled, because there may be
///   no
///                           sheet at all
///   kTared                  an offset was subtracted
///   kHistoryShort           the calibration has a model of the sheet's memory, and what is not known of the
///                           load before (start, gap, time that ran back, another curvature) more than
///                           doubles the deviation; or the reading is saturated: static answer and deviation
///
/// State of the map is the first of these that applies: kSizeMismatch (rows, columns or full scale differ
/// from the calibration's), kWrongSensor, kCurvatureUnknown, kCurvatureStale, kOk. A baseline calibration
/// does not depend on curvature, so its maps are never kCurvatureUnknown or kCurvatureStale.
class Calibrator {
 public:
  /// With the calibration's model of the sheet's memory and the scale of its deviation, if it has them.
  /// Throws InputError if tables are missing or incomplete.
  explicit Calibrator(const Calibration& calibration, const CalibratorOptions& options = {});
  /// Of tables alone: the deviation is theirs. Throws InputError if tables are missing or incomplete, or the
  /// layout has another size.
  Calibrator(const compensation::CurvatureTables& tables, const matrix::Layout& layout,
             const CalibratorOptions& options = {});
  ~Calibrator();
  /// The object moved from can only be destroyed.
  Calibrator(Calibrator&& other) noexcept;

  /// The surface under the matrix as of `time`, the stamp of its message [s]. A surface without curvature
  /// means unknown. Throws InputError, and changes nothing, if it does not fit the matrix.
  void setSurface(const matrix::Surface& surface, double time);

  /// [rows x columns], 1 = ignore this taxel; empty = none. Throws InputError if it does not fit the matrix.
  void setMask(const std::vector<std::uint8_t>& mask);

  /// Subtracted from the pressure of the tables [rows x columns] [Pa]; empty = no tare. Throws InputError if
  /// it does not fit the matrix. With other offsets a
  /// model of the sheet's memory starts anew.
  void setTare(const std::vector<float>& offset);

  /// The sheet has lain without load for long, as after a tare: a model of its memory is settled with the
  /// next scan.
  void markRest();

  /// The measured temperature and the range of training [degree Celsius]. NaN = not known: no taxel is
  /// flagged, and a calibration with a model of the temperature does not correct for it; its deviations then
  /// contain the effect of the temperatures of training. Outside the range, the correction is that of the
  /// nearest temperature that is not flagged.
  void setTemperature(double temperature, double trained_low, double trained_high);

  /// Whether the board is known to be another than the calibration's.
  void setWrongSensor(bool wrong);

  /// The map of one scan; `time` is the scan's stamp [s]. Allocates only if `out` has to grow. If time runs
  /// backwards (a looped bag), windows and ages start again.
  void calibrate(const matrix::ScanView& scan, double time, map::PressureMap& out) noexcept;

  /// Replaces the pressures in the map of the last scan, except NaN, by the answers of the tables after the
  /// tare, without memory and temperature: what a tare is measured with.
  void showTables(map::PressureMap& map) const;

  const matrix::Layout& layout() const;
  /// Memory of the tables [bytes].
  std::size_t bytes() const;
  const health::TaxelWatch& watch() const;
  /// [rows x columns], row-major.
  const std::vector<ClassChoice>& choices() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fsr::calibration
