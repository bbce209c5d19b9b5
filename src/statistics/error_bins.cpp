#include "statistics/error_bins.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace fsr::statistics {

namespace {

constexpr double kBinNormal95 = 1.959963984540054;  // scipy.stats.norm.ppf(0.975)
constexpr int kCellShift = 23 - 12;  // a float has 23 bits below its octave, of which 12 number the cell

std::uint32_t bitsOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

float floatOf(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

void ErrorSizes::add(float error) {
  ++count_;
  if (!octaves_.empty()) {
    tally(std::abs(error), 1);
    return;
  }
  kept_.push_back(std::abs(error));
  if (kept_.size() > kKept) tallyKept();
}

void ErrorSizes::tallyKept() {
  octaves_.resize(kOctaves);
  for (const float size : kept_) tally(size, 1);
  kept_ = {};
}

// The bits of positive floats are in the order of the floats.
void ErrorSizes::tally(float size, std::uint64_t times) {
  const std::uint32_t cell = bitsOf(size) >> kCellShift;
  std::vector<std::uint64_t>& octave = octaves_[cell / kCells];
  if (octave.empty()) octave.resize(kCells);
  octave[cell % kCells] += times;
}

void ErrorSizes::merge(const ErrorSizes& other) {
  count_ += other.count_;
  if (octaves_.empty() && other.octaves_.empty() && kept_.size() + other.kept_.size() <= kKept) {
    kept_.insert(kept_.end(), other.kept_.begin(), other.kept_.end());
    return;
  }
  if (octaves_.empty()) tallyKept();
  for (const float size : other.kept_) tally(size, 1);
  for (std::size_t o = 0; o < other.octaves_.size(); ++o) {
    const std::vector<std::uint64_t>& from = other.octaves_[o];
    if (from.empty()) continue;
    octaves_[o].resize(kCells);
    std::transform(from.begin(), from.end(), octaves_[o].begin(), octaves_[o].begin(), std::plus<>());
  }
}

// Of cells: the errors of a cell are taken to be spread evenly over it.
double ErrorSizes::ordered(std::uint64_t rank) const {
  std::uint64_t below = 0;
  for (std::size_t o = 0; o < octaves_.size(); ++o) {
    for (std::size_t c = 0; c < octaves_[o].size(); ++c) {
      const std::uint64_t here = octaves_[o][c];
      if (rank >= below + here) {
        below += here;
        continue;
      }
      const auto cell = static_cast<std::uint32_t>(o * kCells + c);
      const double low = floatOf(cell << kCellShift);
      const double high = floatOf((cell + 1) << kCellShift);
      return low + (high - low) * (static_cast<double>(rank - below) + 0.5) / static_cast<double>(here);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double ErrorSizes::quantile(double q) const {
  if (octaves_.empty()) {
    std::vector<double> sizes(kept_.begin(), kept_.end());
    return statistics::quantile(sizes, q);
  }
  const double place = q * static_cast<double>(count_ - 1);
  const auto below = static_cast<std::uint64_t>(place);
  const double low = ordered(below);
  const double fraction = place - std::floor(place);
  return fraction == 0 ? low : low + fraction * (ordered(below + 1) - low);
}

void ErrorTally::add(float error) {
  moments_.add(error);
  sizes_.add(error);
}

void ErrorTally::merge(const ErrorTally& other) {
  moments_.merge(other.moments_);
  sizes_.merge(other.sizes_);
}

ErrorSummary ErrorTally::summarise() const {
  ErrorSummary summary;
  summary.count = count();
  if (summary.count == 0) return summary;
  summary.bias = moments_.mean;
  summary.rmse = std::sqrt(moments_.squares / moments_.count + moments_.mean * moments_.mean);
  if (summary.count > 1) {
    summary.limit_low = summary.bias - kBinNormal95 * moments_.deviation();
    summary.limit_high = summary.bias + kBinNormal95 * moments_.deviation();
  }
  summary.p95_absolute = sizes_.quantile(0.95);
  return summary;
}

void ErrorBins::merge(const ErrorBins& other) {
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
    for (std::size_t d = 0; d < kDirections; ++d) tallies_[bin][d].merge(other.tallies_[bin][d]);
  }
}

std::uint64_t ErrorBins::count() const {
  std::uint64_t count = 0;
  for (const auto& bin : tallies_) {
    for (const ErrorTally& tally : bin) count += tally.count();
  }
  return count;
}

BinnedErrors ErrorBins::summarise() const {
  const auto of = [](const std::array<ErrorTally, kDirections>& directions,
                     LoadDirection direction) -> const ErrorTally& {
    return directions[static_cast<std::size_t>(direction)];
  };
  const auto together = [](const std::array<ErrorTally, kDirections>& directions) {
    ErrorTally all;
    for (const ErrorTally& tally : directions) all.merge(tally);
    return all;
  };
  const auto summaryOf = [&](const std::array<ErrorTally, kDirections>& directions) {
    return BinnedErrors::Directions{together(directions).summarise(),
                                    of(directions, LoadDirection::kLoading).summarise(),
                                    of(directions, LoadDirection::kUnloading).summarise()};
  };
  BinnedErrors binned;
  std::array<ErrorTally, kDirections> whole;
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
    binned.bins[bin] = summaryOf(tallies_[bin]);
    for (std::size_t d = 0; d < kDirections; ++d) whole[d].merge(tallies_[bin][d]);
  }
  binned.whole = summaryOf(whole);
  return binned;
}

namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

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

}  // namespace fsr::statistics
