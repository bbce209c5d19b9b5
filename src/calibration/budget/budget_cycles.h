#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/error_budget.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// Where a cycle belongs. Numbers start at 0.
struct BudgetCycle {
  std::uint32_t session = 0;  ///< of its class: a condition of a recording
  std::uint32_t mount = 0;    ///< of its class
  std::uint32_t unit = 0;     ///< of all classes, see IntervalUnit::kCycles
};

/// The cycles of each class, by TrainingScan::cycle.
struct BudgetCycles {
  /// So many units at most: neighbouring cycles are one unit where there are more.
  static constexpr std::size_t kMostUnits = 64;

  std::vector<std::vector<BudgetCycle>> of_class;  ///< [classes][cycles]
  std::size_t units = 0;
};

BudgetCycles budgetCycles(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections);

}  // namespace fsr::calibration
