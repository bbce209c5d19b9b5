#include "conductor/rest_counts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::conductor {

namespace {

// Of normal noise, one reading in 3.5 million is further above its mean.
constexpr double kBeyondNoise = 5;
// Deviation of max(0, z) for a standard normal z: sqrt(1/2 - 1/(2 pi)).
constexpr double kCutOff = 0.5838;

}  // namespace

void RestCounts::restart() {
  *this = {};
}

void RestCounts::take(const std::uint16_t* counts, std::size_t taxels) {
  if (mean_.size() != taxels) {
    restart();
    for (std::vector<double>* one : {&mean_, &squares_, &last_, &differences_}) one->assign(taxels, 0);
  }
  ++scans_;
  for (std::size_t t = 0; t < taxels; ++t) {
    const double step = counts[t] - mean_[t];
    mean_[t] += step / scans_;
    squares_[t] += step * (counts[t] - mean_[t]);
    if (scans_ > 1) differences_[t] += (counts[t] - last_[t]) * (counts[t] - last_[t]);
    last_[t] = counts[t];
  }
}

std::size_t RestCounts::answering(const std::uint16_t* counts, std::size_t taxels) const {
  if (!known() || mean_.size() != taxels) return taxels;
  std::size_t answering = 0;
  for (std::size_t t = 0; t < taxels; ++t) {
    const double deviation = std::sqrt(squares_[t] / (scans_ - 1));
    answering += counts[t] > mean_[t] + kBeyondNoise * deviation + 1 ? 1 : 0;
  }
  return answering;
}

double RestCounts::excess(const std::uint16_t* counts, std::size_t taxels) const {
  if (!known() || mean_.size() != taxels) return std::numeric_limits<double>::quiet_NaN();
  double excess = 0;
  for (std::size_t t = 0; t < taxels; ++t) excess += counts[t] - mean_[t];
  return excess;
}

double RestCounts::noise() const {
  if (!known()) return 0;
  std::vector<double> sorted = differences_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::sqrt(*middle / (2.0 * (scans_ - 1))) / kCutOff;
}

}  // namespace fsr::conductor
