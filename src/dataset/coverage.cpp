#include "dataset/sections.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "settings/number_text.h"

namespace fsr::dataset {

namespace {

CoverageCell& cellOf(ConditionCoverage& coverage, double pressure, statistics::LoadDirection direction) {
  auto& cells = direction == statistics::LoadDirection::kUnloading ? coverage.unloading : coverage.loading;
  return cells[statistics::pressureBin(pressure)];
}

// Adds one condition of one recording. Its cycles are in order, so a cell has a new cycle where the number
// differs from the last one.
void addCondition(const Recording& recording, const Sections& sections, std::size_t condition,
                  ConditionCoverage& coverage) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::array<std::array<std::uint32_t, statistics::kPressureBins>, 2> met;
  for (auto& bins : met) bins.fill(kNone);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (recording.condition[i] != condition || sections.section[i] == kNoSection) continue;
    const double pressure = recording.pressure[i];
    CoverageCell& cell = cellOf(coverage, pressure, sections.direction[i]);
    ++cell.scans;
    auto& last = met[sections.direction[i] == statistics::LoadDirection::kUnloading]
                    [statistics::pressureBin(pressure)];
    if (last != sections.cycle[i]) ++cell.cycles;
    last = sections.cycle[i];
    coverage.pressure_low = coverage.scans == 0 ? pressure : std::min(coverage.pressure_low, pressure);
    coverage.pressure_high = coverage.scans == 0 ? pressure : std::max(coverage.pressure_high, pressure);
    ++coverage.scans;
  }
  coverage.cycles += sections.cycles[condition];
  coverage.mounts.insert(recording.conditions[condition].mount);
}

// A surface with a peak below this share of the highest one lacks data.
constexpr double kEqualPeaks = 0.9;

struct Thin {
  std::uint64_t scans;
  std::string sentence;
};

void judgeCells(const ConditionCoverage& coverage, double highest, std::uint64_t sections,
                std::vector<Thin>& thin) {
  for (const bool unloading : {false, true}) {
    const auto& cells = unloading ? coverage.unloading : coverage.loading;
    for (std::size_t bin = 0; bin < statistics::kPressureBins && statistics::kPressureBinEdges[bin] < highest;
         ++bin) {
      const CoverageCell& cell = cells[bin];
      // another sentence covers conditions with few cycles
      const bool few_cycles = cell.cycles < sections && coverage.cycles >= sections;
      if (cell.scans >= kThinScans && !few_cycles) continue;
      std::ostringstream sentence;
      sentence << coverage.condition.surface << ", "
               << statistics::pressureBinName(bin, settings::shownUnitSize()) << ' '
               << settings::shownUnitName() << ' ' << (unloading ? "unloading" : "loading") << ": ";
      if (cell.scans == 0) {
        sentence << "no scan";
      } else {
        sentence << cell.scans << " scans of " << cell.cycles << (cell.cycles == 1 ? " cycle" : " cycles");
      }
      thin.push_back({cell.scans, sentence.str()});
    }
  }
}

// What the surfaces as a whole lack.
void judgeSurfaces(const std::vector<ConditionCoverage>& conditions, double highest,
                   std::vector<std::string>& sentences) {
  if (conditions.size() == 1) {
    sentences.push_back(
        "there is one surface only: the error on any other one is unknown and can be many times as large");
  }
  for (const ConditionCoverage& condition : conditions) {
    if (condition.pressure_high >= kEqualPeaks * highest) continue;
    sentences.push_back(condition.condition.surface + " was loaded to " +
                        settings::roundedPressure(condition.pressure_high, 6) + " only, others to " +
                        settings::roundedPressure(highest, 6) +
                        ": above that, readings on it and between it and its neighbours are lower limits");
  }
}

}  // namespace

std::vector<std::string> thinPlaces(const std::vector<ConditionCoverage>& conditions, std::size_t sections) {
  double highest = 0;
  for (const ConditionCoverage& condition : conditions) highest = std::max(highest, condition.pressure_high);
  std::vector<Thin> thin;
  for (const ConditionCoverage& condition : conditions) {
    judgeCells(condition, highest, sections, thin);
    if (condition.cycles < sections) {
      thin.push_back({condition.scans, condition.condition.surface + ": " + std::to_string(condition.cycles) +
                                           " cycles, fewer than the " + std::to_string(sections) +
                                           " sections"});
    }
  }
  std::stable_sort(thin.begin(), thin.end(), [](const Thin& a, const Thin& b) { return a.scans < b.scans; });
  std::vector<std::string> sentences;
  if (highest < statistics::kPressureBinEdges.back()) {
    sentences.push_back("no surface was loaded above " + settings::roundedPressure(highest, 6));
  }
  judgeSurfaces(conditions, highest, sentences);
  for (const Thin& entry : thin) sentences.push_back(entry.sentence);
  return sentences;
}

void addCoverage(const ConditionCoverage& more, ConditionCoverage& coverage) {
  if (more.scans > 0) {
    const bool first = coverage.scans == 0;
    coverage.pressure_low = first ? more.pressure_low : std::min(coverage.pressure_low, more.pressure_low);
    coverage.pressure_high =
        first ? more.pressure_high : std::max(coverage.pressure_high, more.pressure_high);
  }
  coverage.scans += more.scans;
  coverage.cycles += more.cycles;
  const auto add = [](const auto& from, auto& to) {
    for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
      to[bin].scans += from[bin].scans;
      to[bin].cycles += from[bin].cycles;
    }
  };
  add(more.loading, coverage.loading);
  add(more.unloading, coverage.unloading);
}

Coverage measureCoverage(const std::vector<Recording>& recordings, const ConditionClasses& classes,
                         const std::vector<Sections>& sections) {
  Coverage coverage;
  for (const CurvatureClass& curvature_class : classes.classes) {
    coverage.conditions.emplace_back();
    coverage.conditions.back().condition = curvature_class;
  }
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t c = 0; c < recordings[r].conditions.size(); ++c) {
      addCondition(recordings[r], sections[r], c, coverage.conditions[classes.class_of[r][c]]);
    }
  }
  coverage.thin = thinPlaces(coverage.conditions, sections.empty() ? 0 : sections.front().number);
  return coverage;
}

Coverage coverageOf(const std::vector<Recording>& recordings, std::size_t sections) {
  std::vector<Sections> divided;
  for (const Recording& recording : recordings) divided.push_back(divideIntoSections(recording, sections));
  return measureCoverage(recordings, poolConditions(recordings), divided);
}

}  // namespace fsr::dataset
