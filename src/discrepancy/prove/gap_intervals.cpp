#include "discrepancy/prove/gap_intervals.h"

#include <algorithm>
#include <cmath>

#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr int kDraws = 400;  // of the bootstrap

Interval middle95(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); }),
               values.end());
  if (values.empty()) return {NAN, NAN};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.025), at(0.975)};
}

}  // namespace

void setIntervals(std::size_t cycles, std::uint64_t seed,
                  const std::function<Gap(const std::vector<std::size_t>& chosen)>& of, Gap& gap) {
  const statistics::RandomStream stream = statistics::randomStream(seed, "discrepancy.gap");
  std::vector<double> before, after, floor, closed;
  std::vector<std::size_t> chosen(cycles);
  for (int draw = 0; draw < kDraws && cycles > 0; ++draw) {
    for (std::size_t c = 0; c < cycles; ++c)
      chosen[c] = stream.bits(static_cast<std::uint64_t>(draw) * cycles + c) % cycles;
    const Gap one = of(chosen);
    before.push_back(one.before);
    after.push_back(one.after);
    floor.push_back(one.floor);
    closed.push_back(one.closed);
  }
  gap.before_interval = middle95(before);
  gap.after_interval = middle95(after);
  gap.floor_interval = middle95(floor);
  gap.closed_interval = middle95(closed);
}

}  // namespace fsr::discrepancy
