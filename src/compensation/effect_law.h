#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/curvature_rule.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/regression/code_table.h"

namespace fsr::compensation {

/// What bending does to one taxel: its table on each class as gain x mean table of all classes + offset, by
/// least squares over the codes that all classes have seen.
struct TaxelEffect {
  std::vector<double> gain;    ///< of each class; empty = the taxel has no model, or no common codes
  std::vector<double> offset;  ///< likewise [Pa]
};

/// `tables` [classes], of one taxel.
TaxelEffect effectOf(const regression::CodeTable* tables, std::size_t classes);

constexpr std::size_t kNoClass = static_cast<std::size_t>(-1);

/// The law of the matrix: gain and offset of each class, mean over taxels, made monotone to either side of
/// flat by isotonic regression. How a taxel departs from it stays in the taxel's own tables. Classes whose
/// curvature differs from taxel to taxel and class `left_out` do not enter; without three classes there is
/// no law (empty).
EffectLaw learnLaw(const std::vector<dataset::CurvatureClass>& classes,
                   const std::vector<TaxelEffect>& taxels, std::size_t left_out = kNoClass);

}  // namespace fsr::compensation
