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

// All sections but `left_out`.
CodeSamples joined(const std::vector<CodeSamples>& sections, std::size_t left_out) {
  CodeSamples all;
  all.full_scale = sections.front().full_scale;
  for (std::size_t section = 0; section < sections.size(); ++section) {
    if (section != left_out) all.append(sections[section]);
  }
  return all;
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

CrossValidatedModel crossValidate(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Regressor& regressor, HeldOutDeviation held_out_deviation) {
  CodeHistogram training = histogramOf(sections, full_scale);
  const Fit whole = regressor.fit(training);
  std::vector<std::vector<double>> held_out(sections.size());
  for (std::size_t section = 0; section < sections.size(); ++section) {
    training.subtract(sections[section]);
    if (training.samples() > 0) held_out[section] = regressor.fit(training).pressure;
    training.add(sections[section]);
  }
  return assembleModel(sections, full_scale, whole, std::move(held_out), held_out_deviation);
}

CrossValidatedModel crossValidateSamples(const std::vector<CodeSamples>& sections, const Regressor& regressor,
                                         HeldOutDeviation held_out_deviation) {
  const std::uint16_t full_scale = sections.front().full_scale;
  const Fit whole = regressor.fitSamples(joined(sections, sections.size()));
  std::vector<CodeStatistics> statistics;
  std::vector<std::vector<double>> held_out(sections.size());
  for (std::size_t section = 0; section < sections.size(); ++section) {
    statistics.push_back(statisticsOf(sections[section]));
    const CodeSamples training = joined(sections, section);
    if (training.size() > 0) held_out[section] = regressor.fitSamples(training).pressure;
  }
  return assembleModel(statistics, full_scale, whole, std::move(held_out), held_out_deviation);
}

}  // namespace fsr::regression
