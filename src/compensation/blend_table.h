#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/curvature_rule.h"
#include "fsr_pressure_map/dataset/condition_classes.h"

namespace fsr::compensation {

/// What a code means: one cache line holds eight neighbouring codes.
struct TableEntry {
  float pressure;   ///< gauge [Pa]
  float deviation;  ///< one standard deviation of a held-out reading [Pa]
};

/// Where a curvature lies among the classes of one taxel.
struct CurvaturePlace {
  std::size_t below = 0;  ///< the class beneath, or the nearest one where none is beneath
  std::size_t above =
      0;             ///< the class above, likewise; the same as `below` on a class or beyond the outer ones
  double share = 0;  ///< of the way from below to above, 0 to 1
  /// Beyond the outer classes: the next one inwards, and the distance in units of theirs.
  std::size_t inner = 0;
  double beyond = 0;

  bool onClass() const { return below == above && beyond == 0; }
};

/// `curvature` [classes], in any order, with at least one value that is no NaN: classes of NaN count as
/// absent.
CurvaturePlace placeOf(double at, const std::vector<double>& curvature);

/// The tables of one taxel: one for each class, `codes` entries each.
struct TaxelTables {
  std::size_t codes = 0;
  std::vector<double> curvature;         ///< of each class at this taxel [1/m]; NaN = leave the class out
  std::vector<const TableEntry*> table;  ///< of each class
  std::vector<const float*> log_weight;  ///< kKernel: logarithm of the kernel sum of each class at each code
};

/// Compiles the one table of a taxel for the curvature `at` [1/m]; `out` has room for tables.codes entries.
/// Pressure follows the rule; kNearest and kByName take the table of class `chosen`. `length_scale` is
/// kKernel's.
///
/// The deviation is that of the neighbours, blended by their shares, and grows between them: midway by what
/// predictions for left-out curvatures were off, or, where that is not known, by half the difference of the
/// neighbours. Beyond the outer classes it grows with the distance, by what the last two classes differ.
///
/// Allocates nothing.
void blendTable(const CurvatureRule& rule, double length_scale, const TaxelTables& tables, double at,
                std::size_t chosen, TableEntry* out);

}  // namespace fsr::compensation
