#include "discrepancy/prove/recompute_gap.h"

#include <algorithm>
#include <cmath>

#include "dataset/count_readers.h"
#include "dataset/sections.h"
#include "discrepancy/fit/signatures.h"

namespace fsr::discrepancy {

namespace {

constexpr std::int64_t kRounding = 1000;  // of stamps that were read as floating point numbers [ns]

bool within(const HoldOutCycles& bag, std::int64_t stamp) {
  return std::any_of(bag.cycles.begin(), bag.cycles.end(), [&](const auto& span) {
    return stamp >= span.first - kRounding && stamp <= span.second + kRounding;
  });
}

struct Sum {
  double squares = 0, number = 0;

  void add(const dataset::Recording& recording, const std::uint16_t* measured,
           const std::vector<std::uint16_t>& counts) {
    for (std::size_t t = 0; t < counts.size(); ++t) {
      if (!recording.mask.empty() && recording.mask[t]) continue;
      squares += std::pow((static_cast<double>(measured[t]) - counts[t]) / recording.full_scale, 2);
      ++number;
    }
  }
  double rms() const { return number > 0 ? std::sqrt(squares / number) : NAN; }
};

}  // namespace

RecomputedGap recomputeGap(const std::vector<dataset::Recording>& recordings,
                           const std::vector<HoldOutCycles>& hold_out,
                           const simulation::SimulationSettings& simulation,
                           const std::function<void(double share)>& progress) {
  std::vector<const dataset::Recording*> order;
  std::vector<dataset::ScanCounts> counts;
  double scans = 0, simulated = 0;
  for (const std::size_t r : dataset::inOrderOfTime(recordings)) {
    order.push_back(&recordings[r]);
    counts.emplace_back(recordings[r]);
    scans += static_cast<double>(recordings[r].scans());
  }
  Sum all;
  std::vector<std::pair<std::string, Sum>> surfaces;
  driveRecordings(order, simulation, [&](std::size_t r, std::size_t i, const simulation::SensorChain& chain) {
    const dataset::Recording& recording = *order[r];
    if (progress) progress(++simulated / scans);
    const std::int64_t stamp = recording.start_ns + std::llround(recording.time[i] * 1e9);
    const bool listed = std::any_of(hold_out.begin(), hold_out.end(), [&](const HoldOutCycles& bag) {
      return bag.file == recording.name && within(bag, stamp);
    });
    if (!listed) return;
    const std::string& surface = recording.conditions.at(recording.condition[i]).name;
    auto of_surface =
        std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& one) { return one.first == surface; });
    if (of_surface == surfaces.end()) of_surface = surfaces.insert(surfaces.end(), {surface, {}});
    const std::uint16_t* const measured = counts[r][i];
    all.add(recording, measured, chain.counts());
    of_surface->second.add(recording, measured, chain.counts());
  });
  RecomputedGap gap{all.rms(), {}};
  for (const auto& [surface, sum] : surfaces) gap.surfaces.emplace_back(surface, sum.rms());
  return gap;
}

}  // namespace fsr::discrepancy
