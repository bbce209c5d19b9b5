#include "regression/cross_validation.h"

#include <algorithm>

#include "regression/held_out_deviation.h"

namespace fsr::regression {

namespace {

CodeHistogram histogramOf(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale) {
  CodeHistogram all(full_scale);
  for (const CodeStatistics& section : sections) all.add(section);
  return all;
}

CodeTable tableOf(const Fit& fit, const CodeHistogram& training) {
  CodeTable table;
  table.pressure.assign(fit.pressure.begin(), fit.pressure.end());
  table.support.assign(fit.support.begin(), fit.support.end());
  const auto occurs = [](std::int64_t count) { return count != 0; };
  const auto& count = training.count();
  const auto first = std::find_if(count.begin(), count.end(), occurs);
  const auto last = std::find_if(count.rbegin(), count.rend(), occurs);
  table.lowest = static_cast<std::uint16_t>(first - count.begin());
  table.highest = static_cast<std::uint16_t>(count.rend() - last - 1);
  return table;
}

}  // namespace

CrossValidatedModel assembleModel(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Fit& whole, std::vector<std::vector<double>> held_out,
                                  HeldOutDeviation held_out_deviation) {
  CrossValidatedModel model{tableOf(whole, histogramOf(sections, full_scale)),
                            std::vector<HeldOutModel>(sections.size())};
  HeldOutErrors errors(full_scale);
  for (std::size_t section = 0; section < sections.size(); ++section) {
    model.held_out[section].pressure = std::move(held_out[section]);
    const bool trained = !model.held_out[section].pressure.empty();
    errors.addSection(trained ? sections[section] : CodeStatistics{}, model.held_out[section].pressure);
  }
  if (errors.empty()) {
    for (const CodeStatistics& section : sections) errors.addSection(section, whole.pressure);
  }
  model.table.deviation = errors.deviation(whole.pressure);
  if (held_out_deviation == HeldOutDeviation::kNo) return model;
  for (std::size_t section = 0; section < sections.size(); ++section) {
    HeldOutModel& without = model.held_out[section];
    if (!without.pressure.empty()) without.deviation = errors.deviation(without.pressure, section);
  }
  return model;
}

}  // namespace fsr::regression
