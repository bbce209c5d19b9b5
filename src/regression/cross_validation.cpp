#include "fsr_pressure_map/regression/cross_validation.h"

#include <algorithm>

#include "fsr_pressure_map/regression/held_out_deviation.h"

namespace fsr {

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

CrossValidatedModel crossValidate(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Regressor& regressor, HeldOutDeviation held_out_deviation) {
  CodeHistogram training = histogramOf(sections, full_scale);
  const Fit fit = regressor.fit(training);
  CrossValidatedModel model{tableOf(fit, training), std::vector<HeldOutModel>(sections.size())};

  HeldOutErrors errors(full_scale);
  for (std::size_t section = 0; section < sections.size(); ++section) {
    const CodeStatistics& held_out = sections[section];
    training.subtract(held_out);
    const bool trainable = training.samples() > 0;
    if (trainable) model.held_out[section].pressure = regressor.fit(training).pressure;
    errors.addSection(trainable ? held_out : CodeStatistics{}, model.held_out[section].pressure);
    training.add(held_out);
  }
  if (errors.empty()) {
    for (const CodeStatistics& section : sections) errors.addSection(section, fit.pressure);
  }
  model.table.deviation = errors.deviation(fit.pressure);
  if (held_out_deviation == HeldOutDeviation::kNo) return model;
  for (std::size_t section = 0; section < sections.size(); ++section) {
    HeldOutModel& held_out = model.held_out[section];
    if (!held_out.pressure.empty()) held_out.deviation = errors.deviation(held_out.pressure, section);
  }
  return model;
}

}  // namespace fsr
