#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compensation/blend_table.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/calibration/error_budget.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr::calibration {

/// CurvatureTables in a layout for look-up: [taxels x models x entries] in one block, so that a scan reads
/// one cache line for each taxel. 7 x 10 taxels, 12 bit, six classes take 14 MB.
///
/// Up to 14 bit each code has its own entry. For a finer converter every second or fourth code has one, and
/// codes between are interpolated linearly: between such close codes the error is small compared with the
/// scatter of a reading. 16 x 10 taxels, 16 bit, six classes take 127 MB instead of 503 MB.
class PackedTables {
 public:
  /// Entries between the tables of one taxel and those of the next: a page (512 entries) and a cache line
  /// (8). 4,096 codes fill whole pages; without the padding the same code of every taxel, e.g. of a sheet at
  /// rest, would be in the same set of the cache. This halves the time of a look-up.
  static constexpr std::size_t kPadding = 512 + 8;

  /// Largest number of codes with an entry for every code.
  static constexpr std::size_t kMostCodes = 16384;

  /// The range of codes in training.
  struct TrainedCodes {
    std::uint16_t lowest;
    std::uint16_t highest;
    bool model;  ///< false: the taxel has no model, its entries are NaN
  };

  /// The deviations are those of the tables times `scale`. Throws InputError if a table has neither one
  /// finite value for each code nor NaN throughout.
  explicit PackedTables(const compensation::CurvatureTables& tables, const DeviationScale& scale = {});
  PackedTables(PackedTables&&) = default;  // not to be copied: it points into itself
  PackedTables(const PackedTables&) = delete;

  matrix::MatrixSize size() const { return size_; }
  std::uint16_t fullScale() const { return full_scale_; }
  std::size_t classes() const { return classes_; }

  /// Number of entries of a table.
  std::size_t entries() const { return (std::size_t{full_scale_} >> shift_) + (shift_ == 0 ? 1 : 2); }
  /// Entry i belongs to code i * 2^shift.
  unsigned shift() const { return shift_; }

  /// The entries of one taxel in one class.
  const compensation::TableEntry* table(std::size_t taxel, std::size_t curvature_class) const {
    return entries_.data() + taxel * stride() + slot_of_class_[curvature_class] * entries();
  }
  /// Memory of all tables [bytes].
  std::size_t bytes() const {
    return entries_.size() * sizeof(compensation::TableEntry) + log_weight_.size() * sizeof(float);
  }
  /// All tables of one taxel, for blendTable().
  const compensation::TaxelTables& tables(std::size_t taxel) const { return of_taxel_[taxel]; }
  TrainedCodes trained(std::size_t taxel, std::size_t curvature_class) const {
    return trained_[number(taxel, curvature_class)];
  }

 private:
  // Moves the last entry, which is beyond full scale, onto the line through the entry before it and full
  // scale.
  void endAtFullScale(compensation::TableEntry* table) const;
  const float* packLogWeight(const regression::CodeTable& table, std::size_t number);
  std::size_t stride() const { return slots_ * entries() + kPadding; }
  std::size_t codeOf(std::size_t entry) const { return std::min<std::size_t>(entry << shift_, full_scale_); }
  std::size_t number(std::size_t taxel, std::size_t curvature_class) const {
    return taxel * classes_ + curvature_class;
  }

  matrix::MatrixSize size_;
  std::uint16_t full_scale_;
  std::size_t classes_;
  std::size_t slots_ = 0;
  std::vector<std::size_t> slot_of_class_;  // classes with the same model share a table
  unsigned shift_ = 0;
  std::vector<compensation::TableEntry> entries_;
  std::vector<TrainedCodes> trained_;  // [taxels x classes]
  std::vector<float> log_weight_;      // [taxels x classes x entries]; empty unless kernels are blended
  std::vector<compensation::TaxelTables> of_taxel_;
};

/// Chooses the curvature class of each taxel: the nearest by principal curvature. While the sheet stays on
/// one surface and mount there is hysteresis, so that a curvature near the middle of two classes does not
/// make the pressure jump between them. If the rule is by name, a surface with the name of a class gets that
/// class, whatever its curvature, and any other surface is between classes.
class ClassSwitch {
 public:
  /// A taxel changes its class only if another is nearer by more than `hysteresis` [1/m]. Only classes,
  /// range, tolerance and rule of `tables` are used.
  ClassSwitch(const compensation::CurvatureTables& tables, double hysteresis);

  /// Chooses the classes for a surface of known curvature that fits the matrix.
  void choose(const matrix::Surface& surface);

  /// Chooses the flattest class of each taxel, for an unknown curvature.
  void fallBack();

  /// [rows x columns], row-major.
  const std::vector<ClassChoice>& choices() const { return choices_; }

 private:
  std::size_t nearest(std::size_t taxel, double curvature) const;
  bool chooseByName(const std::string& name);
  std::size_t keepOrLeave(std::size_t taxel, double curvature) const;
  double distance(std::size_t taxel, std::size_t curvature_class, double curvature) const;
  std::uint16_t flags(std::size_t taxel, std::size_t curvature_class, double curvature) const;

  std::vector<dataset::CurvatureClass> classes_;
  double low_;
  double high_;
  double tolerance_;
  double hysteresis_;
  bool by_name_;
  matrix::Surface last_;  // name and mount only; unknown after fallBack()
  std::vector<ClassChoice> choices_;
};

}  // namespace fsr::calibration
