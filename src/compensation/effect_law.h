#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/regression/code_table.h"

namespace fsr::compensation {

/// The effect of bending on one taxel: its table on each class = gain x mean table of all classes + offset,
/// by least squares over the codes that all classes have seen.
struct TaxelEffect {
  std::vector<double>
      gain;  ///< of each class; empty = the taxel has no model, or the classes have no common codes
  std::vector<double> offset;  ///< likewise [Pa]
};

/// `tables` [classes], of one taxel.
TaxelEffect effectOf(const regression::CodeTable* tables, std::size_t classes);

constexpr std::size_t kNoClass = static_cast<std::size_t>(-1);

/// The law of the matrix: gain and offset of each class, mean over taxels, made monotone on either side of
/// flat by isotonic regression. The difference between a taxel and the law remains in the tables of the
/// taxel. Classes whose curvature differs between taxels, and class `left_out`, are not used. With fewer than
/// three classes there is no law (empty).
EffectLaw learnLaw(const std::vector<dataset::CurvatureClass>& classes,
                   const std::vector<TaxelEffect>& taxels, std::size_t left_out = kNoClass);

}  // namespace fsr::compensation
