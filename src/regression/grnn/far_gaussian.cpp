#include "regression/grnn/far_gaussian.h"

#include <algorithm>
#include <cmath>

#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

// Sums at the codes of a block, and the present power of the `step` of each code.
struct OuterSums {
  OuterSums() { power.fill(1.0); }
  std::array<double, kCodeBlock> step{}, power, pressure{}, weight{};
};

FSR_EACH_VECTOR_WIDTH
void multiply(const double* factor, double* value) {
  for (std::size_t i = 0; i < kCodeBlock; ++i) value[i] *= factor[i];
}

FSR_EACH_VECTOR_WIDTH
void addOuter(double pressure, double weight, OuterSums& sums) {
  for (std::size_t i = 0; i < kCodeBlock; ++i) {
    sums.pressure[i] += pressure * sums.power[i];
    sums.weight[i] += weight * sums.power[i];
  }
}

}  // namespace

void FarGaussian::sumBlock(std::ptrdiff_t begin, std::ptrdiff_t end, KernelMean& mean) {
  const std::vector<std::int32_t>& code = samples_.code;
  if (!code.empty() && (end <= code.front() || begin > code.back())) {
    sumBeyondAll(begin, end, mean);
  } else {
    for (std::ptrdiff_t i = begin; i < end; ++i) sumCode(i, mean);
  }
}

// Starts with the nearest code.
void FarGaussian::sumBeyondAll(std::ptrdiff_t begin, std::ptrdiff_t end, KernelMean& mean) {
  const bool below = end <= samples_.code.front();
  const std::ptrdiff_t edge = below ? samples_.code.front() : samples_.code.back();
  const std::ptrdiff_t nearest = below ? edge - (end - 1) : begin - edge;
  OuterSums sums;
  sums.step = stepPowers();
  const double per_step = std::exp(-2 * precision_ * static_cast<double>(nearest));
  for (double& step : sums.step) step *= per_step;
  std::ptrdiff_t beyond = 0;
  for (std::size_t i = 0; i < samples_.code.size(); ++i) {
    const std::size_t s = below ? i : samples_.code.size() - 1 - i;
    const std::ptrdiff_t j = std::abs(samples_.code[s] - edge);
    if (static_cast<double>((2 * nearest + j) * j) > beyond_nearest_) break;
    for (; beyond < j; ++beyond) multiply(sums.step.data(), sums.power.data());
    addOuter(samples_.sum[s] * shared(j), samples_.count[s] * shared(j), sums);
  }
  for (std::ptrdiff_t i = 0; i < end - begin; ++i) {
    const auto place = static_cast<std::size_t>(i);
    store(below ? end - 1 - i : begin + i, static_cast<double>(nearest + i),
          {sums.pressure[place], sums.weight[place]}, mean);
  }
}

// For codes within a gap between samples or beside one.
void FarGaussian::sumCode(std::ptrdiff_t code, KernelMean& mean) {
  const std::size_t right = samples_.firstFrom(code);
  const bool on_left = right > 0, on_right = right < samples_.code.size();
  const double to_left = on_left ? static_cast<double>(code - samples_.code[right - 1]) : INFINITY;
  const double to_right = on_right ? static_cast<double>(samples_.code[right] - code) : INFINITY;
  const double nearest = std::min(to_left, to_right);
  Sums sums;
  if (on_left) addSide(to_left, nearest, static_cast<std::ptrdiff_t>(right) - 1, -1, sums);
  if (on_right) addSide(to_right, nearest, static_cast<std::ptrdiff_t>(right), 1, sums);
  store(code, nearest, sums, mean);
}

void FarGaussian::store(std::ptrdiff_t code, double nearest, Sums sums, KernelMean& mean) const {
  const double exponent = precision_ * nearest * nearest;
  mean.pressure[static_cast<std::size_t>(code)] = sums.pressure / sums.weight;
  mean.weight[static_cast<std::size_t>(code)] =
      exponent < kLargestKernelExponent ? sums.weight * std::exp(-exponent) : 0.0;
  if (log_weight_ == LogWeight::kNo) return;
  mean.log_weight[static_cast<std::size_t>(code)] = std::log(sums.weight) - exponent;
}

void FarGaussian::addSide(double distance, double nearest, std::ptrdiff_t first, std::ptrdiff_t step,
                          Sums& sums) {
  const double ahead = distance * distance - nearest * nearest;
  if (ahead > beyond_nearest_) return;
  const double per_step = std::exp(-2 * precision_ * distance);
  double power = std::exp(-precision_ * ahead);
  std::ptrdiff_t beyond = 0;  // the first sample [counts]
  const auto number = static_cast<std::ptrdiff_t>(samples_.code.size());
  for (std::ptrdiff_t s = first; s >= 0 && s < number; s += step) {
    const auto sample = static_cast<std::size_t>(s);
    const std::ptrdiff_t j = std::abs(samples_.code[sample] - samples_.code[static_cast<std::size_t>(first)]);
    const auto gap = static_cast<double>(j);
    if (ahead + (2 * distance + gap) * gap > beyond_nearest_) return;
    for (; beyond < j; ++beyond) power *= per_step;
    const double value = power * shared(j);
    sums.pressure += samples_.sum[sample] * value;
    sums.weight += samples_.count[sample] * value;
  }
}

double FarGaussian::shared(std::ptrdiff_t j) {
  for (auto i = shared_.size(); i <= static_cast<std::size_t>(j); ++i) {
    shared_.push_back(std::exp(-precision_ * static_cast<double>(i * i)));
  }
  return shared_[static_cast<std::size_t>(j)];
}

const FarGaussian::BlockValues& FarGaussian::stepPowers() {
  if (step_powers_) return *step_powers_;
  step_powers_.emplace();
  for (std::size_t i = 0; i < step_powers_->size(); ++i) {
    (*step_powers_)[i] = std::exp(-2 * precision_ * static_cast<double>(i));
  }
  return *step_powers_;
}

}  // namespace fsr::regression
