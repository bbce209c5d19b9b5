#include "regression/code_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {

namespace {

[[noreturn]] void refuseOverflow(std::uint16_t code) {
  throw settings::InputError("code " + std::to_string(code) +
                             " occurs more often than its sums can hold; train on fewer scans");
}

[[noreturn]] void refuseCode(std::uint16_t code, std::size_t full_scale) {
  throw settings::InputError("a count is " + std::to_string(code) + ", but the converter's full scale is " +
                             std::to_string(full_scale));
}

// Adds b to a. Throws if a sum would overflow.
void addSums(CodeSums& a, const CodeSums& b) {
  if (__builtin_add_overflow(a.count, b.count, &a.count) || __builtin_add_overflow(a.sum, b.sum, &a.sum) ||
      __builtin_add_overflow(a.sum_of_squares, b.sum_of_squares, &a.sum_of_squares)) {
    refuseOverflow(a.code);
  }
}

}  // namespace

FixedPressure toFixed(double pressure) {
  if (!(std::abs(pressure) <= kLargestPressure)) {
    throw settings::InputError("a pressure is " + std::to_string(pressure) + " Pa, but must lie within +-" +
                               std::to_string(static_cast<std::int64_t>(kLargestPressure)) + " Pa gauge");
  }
  return std::llround(pressure / kFixedPressureUnit);
}

std::uint64_t CodeStatistics::samples() const {
  return std::accumulate(count_.begin(), count_.end(), std::uint64_t{0});
}

void CodeStatistics::reserve(std::size_t codes, std::size_t repeated) {
  code_.reserve(codes);
  count_.reserve(codes);
  sum_.reserve(codes);
  square_.reserve(repeated);
}

void CodeStatistics::append(const CodeSums& sums) {
  code_.push_back(sums.code);
  count_.push_back(sums.count);
  sum_.push_back(sums.sum);
  if (sums.count > 1) square_.push_back(sums.sum_of_squares);
}

void CodeStatistics::merge(const CodeStatistics& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  std::vector<CodeSums> all;
  all.reserve(codes() + other.codes());
  const auto collect = [&all](const CodeSums& sums) { all.push_back(sums); };
  forEach(collect);
  other.forEach(collect);
  std::inplace_merge(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(codes()), all.end(),
                     [](const CodeSums& a, const CodeSums& b) { return a.code < b.code; });
  CodeStatistics merged;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i + 1 < all.size() && all[i + 1].code == all[i].code) {
      addSums(all[i + 1], all[i]);
    } else {
      merged.append(all[i]);
    }
  }
  *this = std::move(merged);
}

bool operator==(const CodeStatistics& a, const CodeStatistics& b) {
  return a.code() == b.code() && a.count() == b.count() && a.sum() == b.sum() && a.square() == b.square();
}

CodeAccumulator::CodeAccumulator(std::uint16_t full_scale)
    : sums_(full_scale + 1u), occupied_(full_scale / 64u + 1u) {}

void CodeAccumulator::add(std::uint16_t code, FixedPressure pressure) {
  if (code >= sums_.size()) refuseCode(code, sums_.size() - 1);
  occupied_[code / 64u] |= std::uint64_t{1} << (code % 64u);
  sums_[code].code = code;
  repeated_ += sums_[code].count == 1;
  addSums(sums_[code], {code, 1, pressure, Int128{pressure} * pressure});
}

CodeStatistics CodeAccumulator::take() {
  CodeStatistics statistics;
  std::size_t codes = 0;
  for (const std::uint64_t bits : occupied_) codes += static_cast<std::size_t>(__builtin_popcountll(bits));
  statistics.reserve(codes, repeated_);
  repeated_ = 0;
  for (std::size_t word = 0; word < occupied_.size(); ++word) {
    for (std::uint64_t bits = occupied_[word]; bits != 0; bits &= bits - 1) {
      CodeSums& sums = sums_[word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits))];
      statistics.append(sums);
      sums = CodeSums{};
    }
    occupied_[word] = 0;
  }
  return statistics;
}

void CodeHistogram::add(std::uint16_t code, FixedPressure pressure) {
  if (code >= count_.size()) refuseCode(code, count_.size() - 1);
  if (__builtin_add_overflow(sum_[code], pressure, &sum_[code])) refuseOverflow(code);
  ++count_[code];
  ++samples_;
}

void CodeHistogram::add(const CodeStatistics& statistics) {
  for (std::size_t i = 0; i < statistics.codes(); ++i) {
    const std::size_t code = statistics.code()[i];
    count_[code] += statistics.count()[i];
    sum_[code] += statistics.sum()[i];
    samples_ += statistics.count()[i];
  }
}

void CodeHistogram::subtract(const CodeStatistics& statistics) {
  for (std::size_t i = 0; i < statistics.codes(); ++i) {
    const std::size_t code = statistics.code()[i];
    count_[code] -= statistics.count()[i];
    sum_[code] -= statistics.sum()[i];
    samples_ -= statistics.count()[i];
  }
}

void CodeHistogram::add(const CodeHistogram& other) {
  for (std::size_t code = 0; code < count_.size(); ++code) {
    count_[code] += other.count_[code];
    sum_[code] += other.sum_[code];
  }
  samples_ += other.samples_;
}

void CodeSamples::append(const CodeSamples& other) {
  code.insert(code.end(), other.code.begin(), other.code.end());
  pressure.insert(pressure.end(), other.pressure.begin(), other.pressure.end());
  curvature.insert(curvature.end(), other.curvature.begin(), other.curvature.end());
}

void validate(const CodeSamples& samples) {
  const bool curvature_fits = samples.curvature.empty() || samples.curvature.size() == samples.size();
  if (samples.pressure.size() != samples.size() || !curvature_fits) {
    throw settings::InputError(
        "training readings are " + std::to_string(samples.size()) + " codes with " +
        std::to_string(samples.pressure.size()) + " pressures and " +
        std::to_string(samples.curvature.size()) +
        " curvatures, but each code must have a pressure, and a curvature each or none");
  }
  const auto highest = std::max_element(samples.code.begin(), samples.code.end());
  if (highest != samples.code.end() && *highest > samples.full_scale) {
    throw settings::InputError("a count is " + std::to_string(*highest) +
                               ", but the converter's full scale is " + std::to_string(samples.full_scale));
  }
}

CodeStatistics statisticsOf(const CodeSamples& samples) {
  validate(samples);
  CodeAccumulator accumulator(samples.full_scale);
  for (std::size_t i = 0; i < samples.size(); ++i) accumulator.add(samples.code[i], samples.pressure[i]);
  return accumulator.take();
}

CodeHistogram histogramOf(const CodeSamples& samples) {
  validate(samples);
  CodeHistogram histogram(samples.full_scale);
  for (std::size_t i = 0; i < samples.size(); ++i) histogram.add(samples.code[i], samples.pressure[i]);
  return histogram;
}

}  // namespace fsr::regression
