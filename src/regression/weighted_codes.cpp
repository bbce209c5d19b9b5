#include "fsr_pressure_map/regression/weighted_codes.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/regression/vector_width.h"

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

namespace {

// (count - 1) count times the variance of the readings, exactly. `Sum` must hold samples x codes^2.
template <typename Sum>
inline __attribute__((always_inline)) Int128 scatterOf(const std::vector<std::int64_t>& count) {
  Sum number = 0, sum = 0, squares = 0;
  for (std::size_t code = 0; code < count.size(); ++code) {
    const auto reading = static_cast<std::int64_t>(code);
    number += count[code];
    sum += Sum{count[code]} * reading;
    squares += Sum{count[code]} * (reading * reading);
  }
  return Int128{number} * squares - Int128{sum} * sum;
}

FSR_EACH_VECTOR_WIDTH
Int128 smallScatterOf(const std::vector<std::int64_t>& count) {
  return scatterOf<std::int64_t>(count);
}

}  // namespace

double readingDeviation(const CodeHistogram& training) {
  if (training.samples() < 2) return 0.0;
  const bool small = training.samples() < std::uint64_t{1} << 31;  // times 2^32 fits 64 bits
  const Int128 scatter = small ? smallScatterOf(training.count()) : scatterOf<Int128>(training.count());
  const auto number = static_cast<double>(training.samples());
  return std::sqrt(static_cast<double>(scatter) / (number * (number - 1)));
}

Fit constantFit(const WeightedCodes& samples) {
  Fit fit{std::vector<double>(samples.table_size, samples.sum.front() / samples.count.front()),
          std::vector<double>(samples.table_size, 0.0)};
  fit.support[static_cast<std::size_t>(samples.code.front())] = samples.count.front();
  return fit;
}

}  // namespace fsr
