#include "dataset/cycles.h"

#include <algorithm>

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
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  const double least = std::max(options.least, options.share_of_range * (*high - *low));
  const std::vector<Turn> turns = turningPoints(pressure, least);
  cycles.direction = directions(turns, pressure.size());
  if (turns.empty()) return cycles;
  cycles.first.push_back(0);
  for (std::size_t i = 1; i < turns.size(); ++i) {
    if (!turns[i].peak) cycles.first.push_back(turns[i].index);
  }
  return cycles;
}

}  // namespace fsr::dataset
