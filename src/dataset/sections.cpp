#include "dataset/sections.h"

#include <algorithm>
#include <cmath>

#include "dataset/cycles.h"
#include "dataset/pressure_rate.h"

namespace fsr::dataset {

namespace {

std::vector<std::size_t> scansOf(const Recording& recording, std::size_t condition) {
  std::vector<std::size_t> scans;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (recording.condition[i] == condition && std::isfinite(recording.pressure[i])) scans.push_back(i);
  }
  return scans;
}

std::vector<double> pressuresOf(const Recording& recording, const std::vector<std::size_t>& scans) {
  std::vector<double> pressure(scans.size());
  std::transform(scans.begin(), scans.end(), pressure.begin(),
                 [&](std::size_t scan) { return recording.pressure[scan]; });
  return pressure;
}

std::string fewCycles(const Recording& recording, std::size_t condition, std::size_t cycles,
                      std::size_t sections) {
  const std::string where = recording.name + ", \"" + recording.conditions[condition].name + "\": ";
  if (cycles == 0)
    return where + "the chamber pressure never changes, so that there is nothing to learn from";
  return where + std::to_string(cycles) + (cycles == 1 ? " cycle is" : " cycles are") + " fewer than the " +
         std::to_string(sections) +
         " sections, which are cut by time instead: a cycle then stands on both sides of a split, and the "
         "scores flatter";
}

void divideCondition(const Recording& recording, std::size_t condition, Sections& sections) {
  const std::vector<std::size_t> scans = scansOf(recording, condition);
  const Cycles cycles = findCycles(pressuresOf(recording, scans));
  sections.cycles.push_back(cycles.count());
  const bool by_cycle = cycles.count() >= sections.number;
  if (!by_cycle)
    sections.warnings.push_back(fewCycles(recording, condition, cycles.count(), sections.number));

  std::size_t cycle = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    while (cycle + 1 < cycles.count() && i >= cycles.first[cycle + 1]) ++cycle;
    const std::size_t place =
        by_cycle ? cycle * sections.number / cycles.count() : i * sections.number / scans.size();
    sections.section[scans[i]] = static_cast<std::uint32_t>(place);
    sections.cycle[scans[i]] = static_cast<std::uint32_t>(cycle);
    sections.direction[scans[i]] = cycles.direction[i];
  }
}

}  // namespace

Sections divideIntoSections(const Recording& recording, std::size_t number) {
  Sections sections;
  sections.number = number;
  sections.section.assign(recording.scans(), kNoSection);
  sections.cycle.assign(recording.scans(), 0);
  sections.direction.assign(recording.scans(), statistics::LoadDirection::kNone);
  sections.dwell = dwellsOf(recording);
  for (std::size_t condition = 0; condition < recording.conditions.size(); ++condition) {
    divideCondition(recording, condition, sections);
  }
  return sections;
}

}  // namespace fsr::dataset
