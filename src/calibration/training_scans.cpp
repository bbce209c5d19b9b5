#include "calibration/training_scans.h"

#include <algorithm>

#include "regression/regressors.h"

namespace fsr::calibration {

TrainingScans gatherScans(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections, const SessionZeros& zeros) {
  const auto zeroOf = [&](std::size_t r, std::size_t condition) -> const regression::FixedPressure* {
    const bool known = !zeros.empty() && !zeros[r].empty() && !zeros[r][condition].empty();
    return known ? zeros[r][condition].data() : nullptr;
  };
  TrainingScans scans(classes.classes.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const dataset::Recording& recording = recordings[r];
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (sections[r].section[i] == dataset::kNoSection) continue;
      scans[classes.class_of[r][recording.condition[i]]].push_back(
          {recording.scan(i), regression::toFixed(recording.pressure[i]), sections[r].section[i],
           sections[r].direction[i], zeroOf(r, recording.condition[i])});
    }
  }
  const auto by_section = [](const TrainingScan& a, const TrainingScan& b) { return a.section < b.section; };
  for (auto& of_class : scans) std::stable_sort(of_class.begin(), of_class.end(), by_section);
  return scans;
}

std::vector<regression::CodeStatistics> statisticsOfTaxel(const TrainingScans& scans, std::size_t sections,
                                                          std::uint16_t full_scale, std::size_t taxel) {
  std::vector<regression::CodeStatistics> cells;
  regression::CodeAccumulator accumulator(full_scale);
  for (const std::vector<TrainingScan>& of_class : scans) {
    auto scan = of_class.begin();
    for (std::size_t section = 0; section < sections; ++section) {
      for (; scan != of_class.end() && scan->section == section; ++scan) {
        accumulator.add(scan->counts[taxel], scan->target(taxel));
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
  for (const std::vector<TrainingScan>& of_class : scans) {
    readings.emplace_back(sections, none);
    for (const TrainingScan& scan : of_class) {
      readings.back()[scan.section].add(scan.counts[taxel], scan.target(taxel));
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
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const auto first = cells.begin() + static_cast<std::ptrdiff_t>(k * sections);
    readings.sums.emplace_back(first, first + static_cast<std::ptrdiff_t>(sections));
  }
  if (!regression::makeRegressor(regressor)->mergeable())
    readings.samples = samplesOfTaxel(scans, sections, full_scale, taxel);
  return readings;
}

}  // namespace fsr::calibration
