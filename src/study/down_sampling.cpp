#include <algorithm>
#include <numeric>

#include "statistics/random_stream.h"
#include "study/study_data.h"

namespace fsr::study {

namespace {

// Draws `kept` of the indices 0 to scans - 1 without replacement (Fisher and Yates); ascending.
std::vector<std::uint32_t> drawn(std::size_t scans, std::size_t kept,
                                 const statistics::RandomStream& stream) {
  std::vector<std::uint32_t> places(scans);
  std::iota(places.begin(), places.end(), 0u);
  for (std::size_t i = 0; i < kept; ++i) {
    const auto left = static_cast<double>(scans - i);
    std::swap(places[i], places[i + static_cast<std::size_t>(stream.uniform(i) * left)]);
  }
  places.resize(kept);
  std::sort(places.begin(), places.end());
  return places;
}

std::vector<std::uint32_t> placesKept(std::size_t scans, std::size_t one_of, DownSampling rule,
                                      const statistics::RandomStream& stream) {
  const std::size_t kept = (scans + one_of - 1) / one_of;
  if (rule == DownSampling::kRandom) return drawn(scans, kept, stream);
  std::vector<std::uint32_t> places(kept);
  const auto begin = static_cast<std::size_t>(stream.uniform(0) * static_cast<double>(scans - kept + 1));
  for (std::size_t i = 0; i < kept; ++i) {
    places[i] = static_cast<std::uint32_t>(rule == DownSampling::kEveryNth ? i * one_of : begin + i);
  }
  return places;
}

}  // namespace

Grouping downSampled(const Grouping& whole, const std::vector<std::size_t>& one_of, DownSampling rule,
                     std::uint64_t seed) {
  Grouping kept{whole.groups, {}};
  for (std::size_t c = 0; c < whole.scans.size(); ++c) {
    std::vector<ScanList> groups(whole.groups);
    for (std::size_t g = 0; g < whole.groups && one_of[c] > 0; ++g) {
      const ScanList& all = whole.scans[c][g];
      const statistics::RandomStream stream =
          statistics::randomStream(seed, "down_sampling_" + std::to_string(one_of[c]), c * whole.groups + g);
      if (all.empty()) continue;
      groups[g] = one_of[c] == 1 ? all : all.picked(placesKept(all.size(), one_of[c], rule, stream));
    }
    kept.scans.push_back(std::move(groups));
  }
  return kept;
}

}  // namespace fsr::study
