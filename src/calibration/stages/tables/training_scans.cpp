#include "calibration/stages/tables/training_scans.h"

#include <algorithm>

#include "regression/regressors.h"

namespace fsr::calibration {

std::vector<std::vector<std::size_t>> firstCycles(const dataset::ConditionClasses& classes,
                                                  const std::vector<dataset::Sections>& sections) {
  std::vector<std::vector<std::size_t>> first(sections.size());
  std::vector<std::size_t> cycles(classes.classes.size(), 0);
  for (std::size_t r = 0; r < sections.size(); ++r) {
    for (std::size_t c = 0; c < sections[r].cycles.size(); ++c) {
      std::size_t& of_class = cycles[classes.class_of[r][c]];
      first[r].push_back(of_class);
      of_class += std::max<std::size_t>(1, sections[r].cycles[c]);
    }
  }
  return first;
}

TrainingScans gatherScans(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections, const SessionZeros& zeros) {
  const auto zeroOf = [&](std::size_t r, std::size_t condition) -> const regression::FixedPressure* {
    const bool known = !zeros.empty() && !zeros[r].empty() && !zeros[r][condition].empty();
    return known ? zeros[r][condition].data() : nullptr;
  };
  const std::vector<std::vector<std::size_t>> first_cycle = firstCycles(classes, sections);
  TrainingScans scans{&recordings, {}, {}};
  scans.of_class.resize(classes.classes.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const dataset::Recording& recording = recordings[r];
    scans.pressure.emplace_back(recording.scans());
    const auto alike = [&](std::size_t i, std::size_t j) {
      return sections[r].section[i] == sections[r].section[j] &&
             recording.condition[i] == recording.condition[j];
    };
    for (std::size_t i = 0, end = 0; i < recording.scans(); i = end) {
      for (end = i + 1; end < recording.scans() && alike(i, end);) ++end;
      const std::uint32_t section = sections[r].section[i], condition = recording.condition[i];
      if (section == dataset::kNoSection) continue;
      for (std::size_t k = i; k < end; ++k) scans.pressure[r][k] = regression::toFixed(recording.pressure[k]);
      scans.of_class[classes.class_of[r][condition]].push_back(
          {static_cast<std::uint32_t>(r), section, i, end, first_cycle[r][condition], zeroOf(r, condition)});
    }
  }
  const auto by_section = [](const TrainingRun& a, const TrainingRun& b) { return a.section < b.section; };
  for (auto& of_class : scans.of_class) std::stable_sort(of_class.begin(), of_class.end(), by_section);
  return scans;
}

std::vector<regression::CodeStatistics> statisticsOfTaxel(const TrainingScans& scans, std::size_t sections,
                                                          std::uint16_t full_scale, std::size_t taxel) {
  std::vector<regression::CodeStatistics> cells;
  regression::CodeAccumulator accumulator(full_scale);
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*scans.recordings, taxel);
  for (const std::vector<TrainingRun>& of_class : scans.of_class) {
    auto run = of_class.begin();
    for (std::size_t section = 0; section < sections; ++section) {
      for (; run != of_class.end() && run->section == section; ++run) {
        const regression::FixedPressure zero = run->zeroOf(taxel);
        scans.forEach(*run, counts, [&](std::uint16_t code, regression::FixedPressure pressure) {
          accumulator.add(code, pressure + zero);
        });
      }
      cells.push_back(accumulator.take());
    }
  }
  return cells;
}

std::vector<std::vector<regression::CodeSamples>> samplesOfTaxel(const TrainingScans& scans,
                                                                 std::size_t sections,
                                                                 std::uint16_t full_scale,
                                                                 std::size_t taxel) {
  regression::CodeSamples none;
  none.full_scale = full_scale;
  std::vector<std::vector<regression::CodeSamples>> readings;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*scans.recordings, taxel);
  for (const std::vector<TrainingRun>& of_class : scans.of_class) {
    readings.emplace_back(sections, none);
    for (const TrainingRun& run : of_class) {
      const regression::FixedPressure zero = run.zeroOf(taxel);
      scans.forEach(run, counts, [&](std::uint16_t code, regression::FixedPressure pressure) {
        readings.back()[run.section].add(code, pressure + zero);
      });
    }
  }
  return readings;
}

compensation::SectionedReadings sectionedReadings(const TrainingScans& scans, std::size_t sections,
                                                  std::uint16_t full_scale, std::size_t taxel,
                                                  const regression::RegressorOptions& regressor) {
  const std::vector<regression::CodeStatistics> cells = statisticsOfTaxel(scans, sections, full_scale, taxel);
  compensation::SectionedReadings readings;
  readings.full_scale = full_scale;
  for (std::size_t k = 0; k < scans.of_class.size(); ++k) {
    const auto first = cells.begin() + static_cast<std::ptrdiff_t>(k * sections);
    readings.sums.emplace_back(first, first + static_cast<std::ptrdiff_t>(sections));
  }
  if (!regression::makeRegressor(regressor)->mergeable())
    readings.samples = samplesOfTaxel(scans, sections, full_scale, taxel);
  return readings;
}

}  // namespace fsr::calibration
