#include "fsr_pressure_map/regression/weighted_codes.h"

#include <algorithm>
#include <cmath>

namespace fsr {

WeightedCodes weightedCodes(const CodeHistogram& training) {
  const std::vector<std::int64_t>& count = training.count();
  const std::size_t occupied = count.size() - std::count(count.begin(), count.end(), 0);
  // Every code is written and kept where it occurs, no branch to mispredict: one place more than kept.
  WeightedCodes samples{count.size(),
                        static_cast<double>(training.samples()),
                        std::vector<std::int32_t>(occupied + 1),
                        std::vector<double>(occupied + 1),
                        std::vector<double>(occupied + 1),
                        std::vector<std::int32_t>(count.size() + 1)};
  std::size_t found = 0;
  for (std::size_t code = 0; code < count.size(); ++code) {
    samples.code[found] = static_cast<std::int32_t>(code);
    samples.count[found] = static_cast<double>(count[code]);
    samples.sum[found] = fromFixed(training.sum()[code]);
    samples.below[code] = static_cast<std::int32_t>(found);
    found += count[code] != 0;
  }
  samples.below.back() = static_cast<std::int32_t>(found);
  samples.code.pop_back();
  samples.count.pop_back();
  samples.sum.pop_back();
  return samples;
}

double readingDeviation(const CodeHistogram& training) {
  std::int64_t count = 0, sum = 0;
  Int128 squares = 0;
  for (std::size_t code = 0; code < training.count().size(); ++code) {
    const std::int64_t here = training.count()[code];
    const auto reading = static_cast<std::int64_t>(code);
    count += here;
    sum += here * reading;
    squares += Int128{here} * (reading * reading);
  }
  if (count < 2) return 0.0;
  const Int128 scatter = count * squares - Int128{sum} * sum;
  return std::sqrt(static_cast<double>(scatter) /
                   (static_cast<double>(count) * static_cast<double>(count - 1)));
}

Fit constantFit(const WeightedCodes& samples) {
  Fit fit{std::vector<double>(samples.table_size, samples.sum.front() / samples.count.front()),
          std::vector<double>(samples.table_size, 0.0)};
  fit.support[static_cast<std::size_t>(samples.code.front())] = samples.count.front();
  return fit;
}

}  // namespace fsr
