#include "calibration/budget/interval_tally.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "statistics/conformal.h"

namespace fsr::calibration {

namespace {

using statistics::kPressureBins;

constexpr std::size_t kLevels = kIntervalLevels.size();
constexpr int kCellShift = 23 - 6;  // a float has 23 bits below its octave, of which 6 number the cell
constexpr std::uint32_t kFirstCell = (127u - 5u) << 6;  // that of 1/32; the bias of the exponent is 127

// `ratio` is not negative.
std::uint32_t numberOf(double ratio) {
  const auto value = static_cast<float>(ratio);
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits >> kCellShift;
}

std::size_t cellOf(double ratio) {
  const std::uint32_t cell = numberOf(ratio);
  return cell < kFirstCell ? 0 : std::min<std::size_t>(cell - kFirstCell, IntervalTally::kCells - 1);
}

double upperEdge(std::size_t cell) {
  const std::uint32_t bits = (kFirstCell + static_cast<std::uint32_t>(cell) + 1) << kCellShift;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

// The cell of which a factor is the upper edge.
std::size_t cellOfFactor(double factor) {
  return numberOf(factor) - kFirstCell - 1;
}

std::size_t placeOf(std::size_t unit, std::size_t bin, std::size_t direction) {
  return ((unit * kPressureBins + bin) * IntervalTally::kDirections + direction) * IntervalTally::kCells;
}

}  // namespace

void IntervalTally::Taxel::add(std::size_t unit, double pressure, statistics::LoadDirection direction,
                               double ratio) {
  if (!std::isfinite(ratio)) return;
  const std::size_t down = direction == statistics::LoadDirection::kUnloading;
  ++counts_[placeOf(unit, statistics::pressureBin(pressure), down) + cellOf(ratio)];
}

IntervalTally::IntervalTally(IntervalUnit unit, std::size_t units, std::size_t taxels)
    : unit_(unit), units_(units), counts_(placeOf(units, 0, 0)), taxels_(taxels) {}

// Whole numbers: the sums do not depend on the order of the taxels.
void IntervalTally::add(std::size_t taxel, const Taxel& readings) {
  const std::lock_guard<std::mutex> lock(adding_);
  std::vector<std::uint32_t>& own = taxels_[taxel];
  own.assign(kPressureBins * kCells, 0);
  for (std::size_t place = 0; place < counts_.size(); ++place) {
    const std::uint32_t count = readings.counts_[place];
    if (count == 0) continue;
    counts_[place] += count;
    own[place / (kDirections * kCells) % kPressureBins * kCells + place % kCells] += count;
  }
}

std::vector<IntervalTally::Shares> IntervalTally::sharesOf(std::size_t first, std::size_t last) const {
  std::vector<Shares> shares;
  for (std::size_t unit = 0; unit < units_; ++unit) {
    Shares sums = {};
    for (std::size_t bin = first; bin <= last; ++bin) {
      for (std::size_t d = 0; d < kDirections; ++d) {
        const std::uint64_t* const counts = &counts_[placeOf(unit, bin, d)];
        for (std::size_t i = 0; i < kCells; ++i) sums[i] += static_cast<double>(counts[i]);
      }
    }
    for (std::size_t i = 1; i < kCells; ++i) sums[i] += sums[i - 1];
    const double all = sums.back();
    if (all == 0) continue;
    for (double& sum : sums) sum /= all;
    shares.push_back(sums);
  }
  return shares;
}

std::optional<std::size_t> IntervalTally::thresholdOf(const std::vector<const Shares*>& units, double level) {
  return statistics::conformalThreshold(units.size(), level, kCells, [&](std::size_t cell) {
    std::vector<double> shares;
    for (const Shares* const unit : units) shares.push_back((*unit)[cell]);
    return shares;
  });
}

BinIntervals IntervalTally::intervalsOf(const std::vector<Shares>& units) {
  BinIntervals intervals;
  intervals.units = units.size();
  std::vector<const Shares*> all;
  for (const Shares& unit : units) all.push_back(&unit);
  for (std::size_t level = 0; level < kLevels; ++level) {
    const auto threshold = thresholdOf(all, kIntervalLevels[level]);
    if (!threshold) continue;
    intervals.factor[level] = upperEdge(*threshold);
    double covered = 0;
    for (std::size_t unit = 0; unit < units.size(); ++unit) {
      std::vector<const Shares*> others = all;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(unit));
      const auto without = thresholdOf(others, kIntervalLevels[level]);
      covered += without ? units[unit][*without] : std::nan("");
    }
    intervals.covered[level] = covered / static_cast<double>(units.size());
  }
  return intervals;
}

void IntervalTally::coverDirections(ErrorIntervals& intervals) const {
  for (std::size_t level = 0; level < kLevels; ++level) {
    for (std::size_t direction = 0; direction < kDirections; ++direction) {
      double within = 0, readings = 0;
      for (std::size_t unit = 0; unit < units_; ++unit) {
        for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
          const double factor = intervals.bins[bin].factor[level];
          if (std::isnan(factor)) continue;
          const std::uint64_t* const counts = &counts_[placeOf(unit, bin, direction)];
          for (std::size_t i = 0; i < kCells; ++i) {
            readings += static_cast<double>(counts[i]);
            if (i <= cellOfFactor(factor)) within += static_cast<double>(counts[i]);
          }
        }
      }
      if (readings > 0) intervals.by_direction[level][direction] = within / readings;
    }
  }
}

void IntervalTally::coverTaxels(ErrorIntervals& intervals) const {
  for (std::size_t level = 0; level < kLevels; ++level) {
    for (const std::vector<std::uint32_t>& taxel : taxels_) {
      double within = 0, readings = 0;
      for (std::size_t place = 0; place < taxel.size(); ++place) {
        const double factor = intervals.bins[place / kCells].factor[level];
        if (std::isnan(factor)) continue;
        readings += taxel[place];
        if (place % kCells <= cellOfFactor(factor)) within += taxel[place];
      }
      intervals.by_taxel[level].push_back(readings > 0 ? within / readings : std::nan(""));
    }
  }
}

ErrorIntervals IntervalTally::summarise() const {
  ErrorIntervals intervals;
  intervals.unit = unit_;
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) intervals.bins[bin] = intervalsOf(sharesOf(bin, bin));
  intervals.whole = intervalsOf(sharesOf(0, kPressureBins - 1));
  coverDirections(intervals);
  coverTaxels(intervals);
  return intervals;
}

}  // namespace fsr::calibration
