#include "fsr_pressure_map/calibration/training_scans.h"

#include <algorithm>

namespace fsr {

TrainingScans gatherScans(const std::vector<Recording>& recordings, const ConditionClasses& classes,
                          const std::vector<Sections>& sections) {
  TrainingScans scans(classes.classes.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const Recording& recording = recordings[r];
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (sections[r].section[i] == kNoSection) continue;
      scans[classes.class_of[r][recording.condition[i]]].push_back(
          {recording.scan(i), toFixed(recording.pressure[i]), sections[r].section[i],
           sections[r].direction[i]});
    }
  }
  const auto by_section = [](const TrainingScan& a, const TrainingScan& b) { return a.section < b.section; };
  for (auto& of_class : scans) std::stable_sort(of_class.begin(), of_class.end(), by_section);
  return scans;
}

std::vector<CodeStatistics> statisticsOfTaxel(const TrainingScans& scans, std::size_t sections,
                                              std::uint16_t full_scale, std::size_t taxel) {
  std::vector<CodeStatistics> cells;
  CodeAccumulator accumulator(full_scale);
  for (const std::vector<TrainingScan>& of_class : scans) {
    auto scan = of_class.begin();
    for (std::size_t section = 0; section < sections; ++section) {
      for (; scan != of_class.end() && scan->section == section; ++scan) {
        accumulator.add(scan->counts[taxel], scan->pressure);
      }
      cells.push_back(accumulator.take());
    }
  }
  return cells;
}

std::vector<std::vector<CodeSamples>> samplesOfTaxel(const TrainingScans& scans, std::size_t sections,
                                                     std::uint16_t full_scale, std::size_t taxel) {
  CodeSamples none;
  none.full_scale = full_scale;
  std::vector<std::vector<CodeSamples>> readings;
  for (const std::vector<TrainingScan>& of_class : scans) {
    readings.emplace_back(sections, none);
    for (const TrainingScan& scan : of_class) {
      readings.back()[scan.section].add(scan.counts[taxel], scan.pressure);
    }
  }
  return readings;
}

}  // namespace fsr
