#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/compensation/blend_table.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"

namespace fsr {

/// CurvatureTables laid out for look-up: [taxels x models x (full_scale + 1)] in one block, so that a
/// scan touches one line for each taxel. 7 x 10 taxels, 12 bit, six classes take 13.8 MB.
class PackedTables {
 public:
  /// Entries between the tables of one taxel and those of the next: a page (512 entries) and a cache line (8)
  /// more than the tables take. 4,096 codes fill whole pages, and the same code of every taxel, as of a sheet
  /// at rest, would want one and the same set of the cache. Halves the time of a look-up.
  static constexpr std::size_t kPadding = 512 + 8;

  /// Codes beyond this lie outside of training on the low side (first) or the high side (second).
  struct TrainedCodes {
    std::uint16_t lowest;
    std::uint16_t highest;
    bool model;  ///< false: training gave this taxel none, its entries are NaN
  };

  /// Throws InputError where a table has not one finite value for each code, nor NaN throughout.
  explicit PackedTables(const CurvatureTables& tables);
  PackedTables(PackedTables&&) = default;  // not to be copied: it points into itself
  PackedTables(const PackedTables&) = delete;

  MatrixSize size() const { return size_; }
  std::uint16_t fullScale() const { return full_scale_; }
  std::size_t classes() const { return classes_; }

  /// The full_scale + 1 entries of one taxel in one class.
  const TableEntry* table(std::size_t taxel, std::size_t curvature_class) const {
    return entries_.data() + taxel * stride() + slot_of_class_[curvature_class] * codes();
  }
  /// All tables of one taxel, for blendTable().
  const TaxelTables& tables(std::size_t taxel) const { return of_taxel_[taxel]; }
  TrainedCodes trained(std::size_t taxel, std::size_t curvature_class) const {
    return trained_[number(taxel, curvature_class)];
  }

 private:
  const float* packLogWeight(const CodeTable& table, std::size_t number);
  std::size_t codes() const { return std::size_t{full_scale_} + 1; }
  std::size_t stride() const { return slots_ * codes() + kPadding; }
  std::size_t number(std::size_t taxel, std::size_t curvature_class) const {
    return taxel * classes_ + curvature_class;
  }

  MatrixSize size_;
  std::uint16_t full_scale_;
  std::size_t classes_;
  std::size_t slots_ = 0;
  std::vector<std::size_t> slot_of_class_;  // classes of one model share a table
  std::vector<TableEntry> entries_;
  std::vector<TrainedCodes> trained_;  // [taxels x classes]
  std::vector<float> log_weight_;      // [taxels x classes x codes]; empty unless kernels are blended
  std::vector<TaxelTables> of_taxel_;
};

}  // namespace fsr
