#include "statistics/streamed_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fsr::statistics {

namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
constexpr double kStreamedNormal95 = 1.959963984540054;  // scipy.stats.norm.ppf(0.975)
constexpr double kQuantile = 0.95;
constexpr std::size_t kHalf = 65536;  // values of 16 bits

std::uint32_t bitsOfSize(float error) {
  const float size = std::abs(error);
  std::uint32_t bits;
  std::memcpy(&bits, &size, sizeof bits);
  return bits;
}

}  // namespace

void ReferenceScatter::add(double reference) {
  number_ += 1;
  sum_ += reference;
  low_ = std::min(low_, reference);
  high_ = std::max(high_, reference);
}

void ReferenceScatter::addAgain(double reference) {
  const double mean = sum_ / number_;
  squares_ += (reference - mean) * (reference - mean);
}

double ReferenceScatter::rSquared(double squared_errors) const {
  return number_ >= 2 && squares_ > 0 ? 1.0 - squared_errors / squares_ : kNoFigure;
}

double ReferenceScatter::rmsePercent(double squared_errors) const {
  return range() > 0 ? 100.0 * std::sqrt(squared_errors / number_) / range() : kNoFigure;
}

StreamedSummary::StreamedSummary() : upper_(kHalf / 2) {}

void StreamedSummary::add(float error) {
  ++count_;
  sum_ += double{error};
  squares_ += double{error} * double{error};
  ++upper_[bitsOfSize(error) >> 16];
}

void StreamedSummary::find(Rank& rank) const {
  for (rank.upper = 0; rank.before + upper_[rank.upper] <= rank.rank; ++rank.upper)
    rank.before += upper_[rank.upper];
}

void StreamedSummary::addAgain(float error) {
  if (!again_) {
    again_ = true;
    mean_ = sum_ / static_cast<double>(count_);
    ranks_[0].rank = static_cast<std::uint64_t>(kQuantile * static_cast<double>(count_ - 1));
    ranks_[1].rank = std::min(ranks_[0].rank + 1, count_ - 1);
    for (Rank& rank : ranks_) {
      find(rank);
      rank.lower.resize(kHalf);
    }
  }
  const double difference = double{error} - mean_;
  squares_about_mean_ += difference * difference;
  const std::uint32_t bits = bitsOfSize(error);
  for (Rank& rank : ranks_)
    if (bits >> 16 == rank.upper) ++rank.lower[bits % kHalf];
}

double StreamedSummary::sizeOf(const Rank& rank) {
  std::uint32_t lower = 0;
  for (std::uint64_t before = rank.before; before + rank.lower[lower] <= rank.rank; ++lower)
    before += rank.lower[lower];
  const std::uint32_t bits = rank.upper << 16 | lower;
  float size;
  std::memcpy(&size, &bits, sizeof size);
  return size;
}

ErrorSummary StreamedSummary::summarise() const {
  ErrorSummary summary;
  summary.count = count_;
  if (count_ == 0) return summary;
  const auto number = static_cast<double>(count_);
  summary.bias = sum_ / number;
  summary.rmse = std::sqrt(squares_ / number);
  const double deviation = count_ < 2 ? kNoFigure : std::sqrt(squares_about_mean_ / (number - 1));
  summary.limit_low = summary.bias - kStreamedNormal95 * deviation;
  summary.limit_high = summary.bias + kStreamedNormal95 * deviation;
  const double place = kQuantile * (number - 1), fraction = place - std::floor(place);
  const double below = sizeOf(ranks_[0]), above = sizeOf(ranks_[1]);
  summary.p95_absolute = fraction == 0 ? below : below + fraction * (above - below);
  return summary;
}

}  // namespace fsr::statistics
