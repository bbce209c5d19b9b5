#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "regression/code_statistics.h"

namespace fsr::compensation {

/// All that the schemes need from the bags: sums of pressure by code for each taxel, curvature class and
/// section.
struct TrainingStatistics {
  std::uint16_t full_scale = 0;
  std::size_t taxels = 0;
  std::size_t sections = 0;
  std::vector<dataset::CurvatureClass> classes;   ///< by ascending curvature of taxel 0
  std::vector<regression::CodeStatistics> cells;  ///< [taxels x classes x sections]
  /// The conditions that were pooled into classes: those of each bag, bag after bag.
  std::vector<dataset::RecordedCondition> conditions;

  const regression::CodeStatistics& cell(std::size_t taxel, std::size_t curvature_class,
                                         std::size_t section) const {
    return cells[(taxel * classes.size() + curvature_class) * sections + section];
  }
};

}  // namespace fsr::compensation
