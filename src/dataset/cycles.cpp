#include "dataset/cycles.h"

#include <algorithm>
#include <array>

namespace fsr::dataset {

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

}  // namespace fsr::dataset
