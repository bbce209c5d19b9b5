#include "dataset/sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "dataset/protocols.h"

namespace fsr::dataset {

std::vector<std::size_t> inOrderOfTime(const std::vector<Recording>& recordings) {
  std::vector<std::size_t> order(recordings.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return recordings[a].start_ns < recordings[b].start_ns;
  });
  return order;
}

bool sheetLayOn(const Recording& before, const Recording& after) {
  constexpr double kLongest = 3600;  // numbers of mounts begin again with the driver [s]
  if (before.scans() == 0 || after.scans() == 0 || before.sensor.serial != after.sensor.serial) return false;
  const matrix::Surface& surface = after.conditions[after.condition.front()];
  const double pause =
      double(after.start_ns - before.start_ns) * 1e-9 + after.time.front() - before.time.back();
  return surface.mount > 0 && matrix::sameCondition(before.conditions[before.condition.back()], surface) &&
         pause > 0 && pause <= kLongest;
}

namespace {

struct Turn {
  std::size_t index;
  bool peak;  // else a valley
};

// Alternating peaks and valleys. After each the pressure returns by at least `least` [Pa].
std::vector<Turn> turningPoints(const std::vector<double>& pressure, double least) {
  std::vector<Turn> turns;
  std::size_t low = 0, high = 0;  // extremes since the last turning point
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    if (pressure[i] > pressure[high]) high = i;
    if (pressure[i] < pressure[low]) low = i;
    const bool after_valley = !turns.empty() && !turns.back().peak;
    const bool after_peak = !turns.empty() && turns.back().peak;
    if (!after_peak && pressure[high] - pressure[i] >= least) {
      turns.push_back({high, true});
      low = i;
    } else if (!after_valley && pressure[i] - pressure[low] >= least) {
      turns.push_back({low, false});
      high = i;
    }
  }
  return turns;
}

// Value for a reading that is a spike of at least `least` [Pa], else the reading. A spike differs from both
// neighbours, while three of the four readings around it are alike: beside the peak of a cycle they are not,
// and a second spike may be near.
double withoutSpike(const std::vector<double>& pressure, std::size_t i, double least) {
  std::array<double, 4> around = {pressure[i - 2], pressure[i - 1], pressure[i + 1], pressure[i + 2]};
  const auto [low, high] = std::minmax(around[1], around[2]);
  std::sort(around.begin(), around.end());
  const double above = pressure[i] - high, below = low - pressure[i];
  if (above >= least && around[2] - around[0] < above / 2) return high;
  if (below >= least && around[3] - around[1] < below / 2) return low;
  return pressure[i];
}

std::vector<double> withoutSpikes(const std::vector<double>& pressure, double least) {
  std::vector<double> calm = pressure;
  for (std::size_t i = 2; i + 2 < pressure.size(); ++i) calm[i] = withoutSpike(pressure, i, least);
  return calm;
}

std::vector<statistics::LoadDirection> directions(const std::vector<Turn>& turns, std::size_t readings) {
  std::vector<statistics::LoadDirection> direction(readings, statistics::LoadDirection::kNone);
  if (turns.empty()) return direction;
  std::fill(direction.begin(), direction.end(),
            turns.front().peak ? statistics::LoadDirection::kLoading : statistics::LoadDirection::kUnloading);
  for (const Turn& turn : turns) {
    std::fill(direction.begin() + static_cast<std::ptrdiff_t>(turn.index) + 1, direction.end(),
              turn.peak ? statistics::LoadDirection::kUnloading : statistics::LoadDirection::kLoading);
  }
  return direction;
}

}  // namespace

Cycles findCycles(const std::vector<double>& pressure, const CycleOptions& options) {
  Cycles cycles;
  if (pressure.empty()) return cycles;
  const auto leastOf = [&options](const std::vector<double>& course) {
    const auto [low, high] = std::minmax_element(course.begin(), course.end());
    return std::max(options.least, options.share_of_range * (*high - *low));
  };
  // Much smaller spikes than cycles make cycles of noise. They widen the range, so small ones show after
  // large ones were taken out.
  constexpr double kOfCycle = 0.25;
  std::vector<double> calm = pressure;
  for (int round = 0; round < 2; ++round) calm = withoutSpikes(calm, kOfCycle * leastOf(calm));
  const std::vector<Turn> turns = turningPoints(calm, leastOf(calm));
  cycles.direction = directions(turns, pressure.size());
  if (turns.empty()) return cycles;
  cycles.first.push_back(0);
  for (std::size_t i = 1; i < turns.size(); ++i) {
    if (!turns[i].peak) cycles.first.push_back(turns[i].index);
  }
  return cycles;
}

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
