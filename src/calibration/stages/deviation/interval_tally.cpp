#include "calibration/stages/deviation/interval_tally.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "settings/number_text.h"
#include "statistics/conformal.h"
#include "statistics/samples.h"

namespace fsr::calibration {

namespace {

double factorOf(const BinScale& bin) {
  return std::isnan(bin.factor) ? 1 : bin.factor;
}

}  // namespace

bool DeviationScale::present() const {
  return std::any_of(bins.begin(), bins.end(),
                     [](const BinScale& bin) { return !std::isnan(bin.pressure) && factorOf(bin) != 1; });
}

double DeviationScale::at(double pressure) const {
  const BinScale* below = nullptr;
  for (const BinScale& bin : bins) {
    if (std::isnan(bin.pressure)) continue;
    if (!(pressure > bin.pressure)) {
      if (below == nullptr) return factorOf(bin);
      const double share = (pressure - below->pressure) / (bin.pressure - below->pressure);
      return factorOf(*below) + share * (factorOf(bin) - factorOf(*below));
    }
    below = &bin;
  }
  return below == nullptr ? 1 : factorOf(*below);
}

std::string deviationText(const DeviationScale& scale) {
  const std::string tables = "that of the tables";
  if (!scale.present()) return tables;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const BinScale& bin : scale.bins) {
    if (std::isnan(bin.pressure)) continue;
    low = std::min(low, factorOf(bin)), high = std::max(high, factorOf(bin));
  }
  return tables + " times " + settings::fixedText(low, 2) + " to " + settings::fixedText(high, 2) +
         " by pressure";
}

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

// Fewest units with a factor for the deviation: with one of them left out, there must be another to check it.
constexpr std::size_t kFewestUnits = 4;
constexpr double kOneDeviation = kIntervalLevels[0];
constexpr std::size_t kHalves = IntervalTally::kHalves;

// `part`: half of a bin, kHalves x bin + half.
std::size_t placeOf(std::size_t unit, std::size_t part, std::size_t direction) {
  return ((unit * kPressureBins * kHalves + part) * IntervalTally::kDirections + direction) *
         IntervalTally::kCells;
}

// Readings at or below `ratio`, where those of its cell are spread evenly.
double within(const std::uint64_t* counts, double ratio) {
  const std::size_t last = cellOf(ratio);
  double sum = 0;
  for (std::size_t cell = 0; cell < last; ++cell) sum += static_cast<double>(counts[cell]);
  const double low = last == 0 ? 0 : upperEdge(last - 1), high = upperEdge(last);
  return sum + std::min(1.0, (ratio - low) / (high - low)) * static_cast<double>(counts[last]);
}

}  // namespace

void IntervalTally::Taxel::add(std::size_t unit, double pressure, statistics::LoadDirection direction,
                               double ratio) {
  if (!std::isfinite(ratio)) return;
  const std::size_t down = direction == statistics::LoadDirection::kUnloading;
  const std::size_t bin = statistics::pressureBin(pressure);
  const std::size_t half = pressure >= tally_->middleOf(bin);
  ++counts_[placeOf(unit, kHalves * bin + half, down) + cellOf(ratio)];
}

IntervalTally::IntervalTally(IntervalUnit unit, std::size_t units, std::size_t taxels, double highest)
    : unit_(unit), units_(units), highest_(highest), counts_(placeOf(units, 0, 0)), taxels_(taxels) {}

// The highest bin ends at the highest pressure of training.
double IntervalTally::middleOf(std::size_t bin) const {
  const double low = statistics::kPressureBinEdges[bin];
  const double high =
      bin + 1 < kPressureBins ? statistics::kPressureBinEdges[bin + 1] : std::max(low, highest_);
  return (low + high) / 2;
}

double IntervalTally::middleOf(std::size_t bin, std::size_t half) const {
  const double middle = middleOf(bin), quarter = (middle - statistics::kPressureBinEdges[bin]) / 2;
  return half == 0 ? middle - quarter : middle + quarter;
}

// Whole numbers: the sums do not depend on the order of the taxels.
void IntervalTally::add(std::size_t taxel, const Taxel& readings) {
  const std::lock_guard<std::mutex> lock(adding_);
  std::vector<std::uint32_t>& own = taxels_[taxel];
  own.assign(kPressureBins * kCells, 0);
  for (std::size_t place = 0; place < counts_.size(); ++place) {
    const std::uint32_t count = readings.counts_[place];
    if (count == 0) continue;
    counts_[place] += count;
    own[place / (kHalves * kDirections * kCells) % kPressureBins * kCells + place % kCells] += count;
  }
}

std::vector<std::optional<IntervalTally::Shares>> IntervalTally::sharesByUnit(std::size_t first,
                                                                              std::size_t last) const {
  std::vector<std::optional<Shares>> shares(units_);
  for (std::size_t unit = 0; unit < units_; ++unit) {
    Shares sums = {};
    for (std::size_t part = kHalves * first; part < kHalves * (last + 1); ++part) {
      for (std::size_t d = 0; d < kDirections; ++d) {
        const std::uint64_t* const counts = &counts_[placeOf(unit, part, d)];
        for (std::size_t i = 0; i < kCells; ++i) sums[i] += static_cast<double>(counts[i]);
      }
    }
    for (std::size_t i = 1; i < kCells; ++i) sums[i] += sums[i - 1];
    const double all = sums.back();
    if (all == 0) continue;
    for (double& sum : sums) sum /= all;
    shares[unit] = sums;
  }
  return shares;
}

std::vector<IntervalTally::Shares> IntervalTally::sharesOf(std::size_t first, std::size_t last) const {
  std::vector<Shares> shares;
  for (const std::optional<Shares>& own : sharesByUnit(first, last)) {
    if (own) shares.push_back(*own);
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
        for (std::size_t part = 0; part < kHalves * kPressureBins; ++part) {
          const double factor = intervals.bins[part / kHalves].factor[level];
          if (std::isnan(factor)) continue;
          const std::uint64_t* const counts = &counts_[placeOf(unit, part, direction)];
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

// The deviation of the tables was found on left-out cycles already, so that a second factor from cycles only
// adds scatter. A standard deviation guarantees nothing, so its rank is not rounded up as that of an interval
// is: the place (n + 1) level is between two ranks.
DeviationScale IntervalTally::factorsWithout(
    std::size_t skipped, const std::vector<std::vector<std::optional<Shares>>>& of_bin) const {
  DeviationScale scale;
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
    std::vector<const Shares*> units;
    std::size_t all = 0;
    for (std::size_t unit = 0; unit < units_; ++unit) {
      all += of_bin[bin][unit].has_value();
      if (unit != skipped && of_bin[bin][unit]) units.push_back(&*of_bin[bin][unit]);
    }
    if (all == 0) continue;
    scale.bins[bin].pressure = middleOf(bin);
    if (unit_ == IntervalUnit::kCycles || all < kFewestUnits) continue;
    const auto shares = [&](std::size_t cell) {
      std::vector<double> at;
      for (const Shares* const unit : units) at.push_back((*unit)[cell]);
      return at;
    };
    const double place = (static_cast<double>(units.size()) + 1) * kOneDeviation;
    const auto rank = static_cast<std::size_t>(place);
    const double low = upperEdge(statistics::medianThreshold(rank, kCells, shares));
    const double high = upperEdge(statistics::medianThreshold(rank + 1, kCells, shares));
    scale.bins[bin].factor = low + (place - static_cast<double>(rank)) * (high - low);
  }
  return scale;
}

DeviationScale IntervalTally::scale() const {
  std::vector<std::vector<std::optional<Shares>>> of_bin;
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) of_bin.push_back(sharesByUnit(bin, bin));
  DeviationScale scale = factorsWithout(units_, of_bin);
  // Means over units: the last entry is that of all bins.
  std::array<statistics::RunningMoments, kPressureBins + 1> tables, map;
  for (std::size_t unit = 0; unit < units_; ++unit) {
    const DeviationScale others = factorsWithout(unit, of_bin);
    double all = 0, all_tables = 0, all_map = 0;
    for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
      if (!of_bin[bin][unit]) continue;
      double readings = 0, in_tables = 0, in_map = 0;
      for (std::size_t half = 0; half < kHalves; ++half) {
        const double factor = others.at(middleOf(bin, half));
        for (std::size_t d = 0; d < kDirections; ++d) {
          const std::uint64_t* const counts = &counts_[placeOf(unit, kHalves * bin + half, d)];
          for (std::size_t cell = 0; cell < kCells; ++cell) readings += static_cast<double>(counts[cell]);
          in_tables += within(counts, 1);
          in_map += within(counts, factor);
        }
      }
      tables[bin].add(in_tables / readings);
      map[bin].add(in_map / readings);
      all += readings, all_tables += in_tables, all_map += in_map;
    }
    if (all == 0) continue;
    tables.back().add(all_tables / all);
    map.back().add(all_map / all);
  }
  for (std::size_t bin = 0; bin <= kPressureBins; ++bin) {
    BinScale& own = bin < kPressureBins ? scale.bins[bin] : scale.whole;
    if (tables[bin].count > 0) own.within_tables = tables[bin].mean, own.within_map = map[bin].mean;
  }
  return scale;
}

ErrorIntervals IntervalTally::summarise() const {
  ErrorIntervals intervals;
  intervals.unit = unit_;
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) intervals.bins[bin] = intervalsOf(sharesOf(bin, bin));
  intervals.whole = intervalsOf(sharesOf(0, kPressureBins - 1));
  coverDirections(intervals);
  coverTaxels(intervals);
  intervals.scale = scale();
  return intervals;
}

}  // namespace fsr::calibration
