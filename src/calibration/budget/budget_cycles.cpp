#include "calibration/budget/budget_cycles.h"

#include <algorithm>
#include <map>

#include "calibration/training_scans.h"

namespace fsr::calibration {

BudgetCycles budgetCycles(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections) {
  BudgetCycles cycles;
  cycles.of_class.resize(classes.classes.size());
  std::vector<std::uint32_t> sessions(classes.classes.size(), 0);
  std::vector<std::map<std::uint32_t, std::uint32_t>> mounts(classes.classes.size());
  const std::vector<std::vector<std::size_t>> first = firstCycles(classes, sections);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t c = 0; c < recordings[r].conditions.size(); ++c) {
      const std::size_t k = classes.class_of[r][c];
      const auto number = static_cast<std::uint32_t>(mounts[k].size());
      const std::uint32_t mount = mounts[k].emplace(recordings[r].conditions[c].mount, number).first->second;
      const std::size_t last = cycleNumber(first[r][c] + std::max<std::size_t>(1, sections[r].cycles[c]) - 1);
      if (cycles.of_class[k].size() <= last) cycles.of_class[k].resize(last + 1, {sessions[k], mount, 0});
      ++sessions[k];
    }
  }
  std::size_t all = 0, number = 0;
  for (const auto& of_class : cycles.of_class) all += of_class.size();
  cycles.units = std::min(all, BudgetCycles::kMostUnits);
  for (auto& of_class : cycles.of_class) {
    for (BudgetCycle& cycle : of_class)
      cycle.unit = static_cast<std::uint32_t>(number++ * cycles.units / all);
  }
  return cycles;
}

}  // namespace fsr::calibration
