#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/calibration/class_switch.h"
#include "fsr_pressure_map/calibration/packed_tables.h"
#include "fsr_pressure_map/health/taxel_watch.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/scan.h"

namespace fsr::calibration {

/// Choices of the user at the live path; every default stands here.
struct CalibratorOptions {
  double class_hysteresis = 0.5;  ///< a taxel leaves its class only when another is nearer by more [1/m]
  double curvature_timeout = 0;   ///< an older surface is stale [s]; 0 = never
  double curvature_step =
      0.02;  ///< a taxel's blended table is compiled anew when curvature moved by more [1/m]
  bool fill_bad_taxels = false;  ///< dead and stuck taxels take the mean of their neighbours, flagged
  health::TaxelWatchOptions watch;
};

/// Turns scans into pressure maps, one table look-up a taxel, whatever the scheme: a surface whose table is
/// not among the calibration's has one compiled for each taxel when it comes (see blend_table.h). It owns
/// what the live path remembers: the surface and the class switch, mask, tare, and the watch for dead and
/// stuck taxels.
///
/// Flags of a taxel:
///   kSaturated              code at full scale: "at least"
///   kReadingExtrapolated    code beyond those of training, low or high
///   kBelowRange             code 0, no conductance: any pressure under the turn-on reads so, "less than";
///                           likewise a code below those of training, as of a taxel at rest beside a load
///   kCurvatureExtrapolated  curvature of a sign or size that training never saw
///   kBetweenClasses         curvature farther than the class tolerance from the class in use
///   kDead, kStuck           see TaxelWatch; no reading (NaN) unless filled (kFilled)
///   kMasked                 masked, or there is no model for it here: no reading, and never filled, for
///                           there may be no sheet at all
///   kTared                  an offset was taken off
///
/// State of the map, the first that holds: kSizeMismatch (rows, columns or full scale are not the
/// calibration's), kWrongSensor, kCurvatureUnknown, kCurvatureStale, kOk. A baseline calibration is one
/// for all curvatures and asks for none, so it is never unknown or stale.
class Calibrator {
 public:
  /// Throws InputError where the tables are not whole or the layout is not theirs.
  Calibrator(const compensation::CurvatureTables& tables, const matrix::Layout& layout,
             const CalibratorOptions& options = {});
  Calibrator(Calibrator&&) = default;  // not to be copied: it points into its own tables
  Calibrator(const Calibrator&) = delete;

  /// The surface under the matrix as of `time`, the stamp of its message [s]; one without curvature means
  /// unknown. Throws InputError, and changes nothing, where it does not fit the matrix.
  void setSurface(const matrix::Surface& surface, double time);

  /// 1 = ignore this taxel; empty = none. Throws InputError where it does not fit the matrix.
  void setMask(const std::vector<std::uint8_t>& mask);

  /// Taken off the table's pressure [rows x columns] [Pa]; empty = no tare. Throws InputError likewise.
  void setTare(const std::vector<float>& offset);

  /// Whether the board is known to be another than the calibration's.
  void setWrongSensor(bool wrong) { wrong_sensor_ = wrong; }

  /// The map of one scan; `time` is the scan's stamp [s]. Allocates only where `out` has to grow.
  /// Time that runs back (a looped bag) starts windows and ages anew.
  void calibrate(const matrix::ScanView& scan, double time, map::PressureMap& out) noexcept;

  const matrix::Layout& layout() const { return layout_; }
  /// What the tables take [bytes].
  std::size_t bytes() const { return tables_.bytes() + blended_.size() * sizeof(compensation::TableEntry); }
  const health::TaxelWatch& watch() const { return watch_; }
  const std::vector<ClassSwitch::Choice>& choices() const { return switch_.choices(); }

 private:
  void selectTables(const matrix::Surface& surface);
  void selectTable(std::size_t taxel, double curvature);
  const compensation::TableEntry* blended(std::size_t taxel, double curvature);
  void refreshStanding() noexcept;
  void noteTime(double time) noexcept;
  void clip(const std::uint16_t* counts) noexcept;
  void lookUp(map::PressureMap& out) const noexcept;
  void flagCodes(map::PressureMap& out) const noexcept;
  void strikeBad(map::PressureMap& out) const noexcept;
  map::MapState state(double time) const noexcept;

  PackedTables tables_;
  matrix::Layout layout_;
  CalibratorOptions options_;
  bool needs_curvature_;
  compensation::CurvatureRule rule_;
  ClassSwitch switch_;
  health::TaxelWatch watch_;

  bool surface_known_ = false;
  double surface_time_ = 0;  // [s]
  double last_time_ = 0;     // [s]
  bool wrong_sensor_ = false;
  std::vector<std::uint8_t> mask_;   // [taxels]
  std::vector<std::uint8_t> model_;  // [taxels], 0 = the table in use is empty

  // Tables compiled for the curvature at hand, and what for; allocated with the first one.
  struct Blended {
    double curvature;
    std::size_t chosen;
    bool finite;
  };
  std::vector<compensation::TableEntry> blended_;  // [taxels x stride]
  std::vector<Blended> blended_for_;               // [taxels]
  bool tared_ = false;

  // What the loop over taxels reads, each [taxels], row-major.
  std::vector<std::uint16_t> codes_;  // of the scan, none beyond full scale
  std::vector<const compensation::TableEntry*> table_;
  std::vector<float> offset_;          // [Pa]
  std::vector<std::uint16_t> lowest_;  // trained codes of the table in use
  std::vector<std::uint16_t> highest_;
  std::vector<std::uint16_t> standing_;  // flags that do not depend on the code
  std::vector<std::size_t> masked_;      // taxels without a reading, never filled
  std::vector<std::size_t> failed_;      // dead or stuck taxels that are not masked
};

}  // namespace fsr::calibration
