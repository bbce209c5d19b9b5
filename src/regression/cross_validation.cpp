#include "regression/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fsr::regression {

namespace {

// A quantile of fewer readings is unreliable, because readings that follow each other are alike.
constexpr double kLeastReadingsOfGroup = 500.0;
// The factor of all groups counts like this many readings of the group.
constexpr double kPriorOfScale = 100.0;
constexpr double kLargestRatio = 4.0;

}  // namespace

DeviationScale::DeviationScale(const std::vector<double>& readings) : group_of_code_(readings.size(), 0) {
  const double total = std::accumulate(readings.begin(), readings.end(), 0.0);
  const double groups = std::clamp(std::floor(total / kLeastReadingsOfGroup), 1.0, double{kGroups});
  double below = 0;
  for (std::size_t code = 0; code < readings.size(); ++code) {
    const auto group =
        static_cast<std::uint8_t>(total > 0 ? std::min(groups - 1, below / total * groups) : 0);
    group_of_code_[code] = group;
    readings_[group] += readings[code];
    centre_[group] += readings[code] * static_cast<double>(code);
    below += readings[code];
  }
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (readings_[group] > 0) centre_[group] /= readings_[group];
  }
  ratios_.resize(static_cast<std::size_t>(groups), Histogram{});
}

void DeviationScale::add(std::uint16_t code, double ratio, double weight) {
  const double bin = std::min(std::abs(ratio) * (kBins / kLargestRatio), kBins - 1.0);
  ratios_[group_of_code_[code]][static_cast<std::size_t>(bin)] += weight;
}

double DeviationScale::quantile(const Histogram& histogram) {
  double missing = kShareWithinOneDeviation * std::accumulate(histogram.begin(), histogram.end(), 0.0);
  std::size_t bin = 0;
  while (bin + 1 < kBins && histogram[bin] < missing) missing -= histogram[bin++];
  const double inside = histogram[bin] > 0 ? missing / histogram[bin] : 1.0;
  return (static_cast<double>(bin) + inside) * (kLargestRatio / kBins);
}

std::vector<double> DeviationScale::factors() const {
  Histogram all{};
  for (const Histogram& group : ratios_) {
    std::transform(all.begin(), all.end(), group.begin(), all.begin(), std::plus<>());
  }
  std::vector<double> factors(group_of_code_.size(), 1.0);
  if (std::accumulate(all.begin(), all.end(), 0.0) == 0) return factors;
  const double of_all = quantile(all);
  double left_centre = 0, left_factor = 0;
  std::size_t code = 0;
  for (std::size_t group = 0; group < ratios_.size(); ++group) {
    if (readings_[group] == 0) continue;
    const double own = quantile(ratios_[group]);
    const double factor =
        (readings_[group] * own + kPriorOfScale * of_all) / (readings_[group] + kPriorOfScale);
    if (code == 0) left_factor = factor;  // constant below the first centre
    for (; code < factors.size() && static_cast<double>(code) <= centre_[group]; ++code) {
      const double width = centre_[group] - left_centre;
      const double share = width > 0 ? (static_cast<double>(code) - left_centre) / width : 1.0;
      factors[code] = left_factor + share * (factor - left_factor);
    }
    left_centre = centre_[group];
    left_factor = factor;
  }
  std::fill(factors.begin() + static_cast<std::ptrdiff_t>(code), factors.end(), left_factor);
  return factors;
}

namespace {

// With this many readings of a code its own errors and those of its neighbourhood have equal weight; likewise
// the neighbourhood and all codes.
constexpr double kPriorOfDeviation = 30.0;
// Half width of a neighbourhood, as a share of the codes that occur: narrow compared with the bends of a
// sensor's curve, wide enough to contain a hundred readings of a recording of ten minutes at 10 Hz.
constexpr double kNeighbourhood = 1.0 / 64.0;
constexpr double kLeastDeviation = 1.0;  // [Pa]

// Readings of one code in one section are known by number, mean and standard deviation. They are represented
// by these points, in units of the standard deviation: two readings are at mean +- deviation, more are
// assumed to be normally distributed (the quantiles of 1/12, 3/12 ... 11/12, scaled to unit variance).
const std::vector<double> kOne = {0.0};
const std::vector<double> kTwo = {-1.0, 1.0};
const std::vector<double> kMore = {-1.54242, -0.75224, -0.23469, 0.23469, 0.75224, 1.54242};

const std::vector<double>& pointsOf(double count) {
  return count > 2 ? kMore : count > 1 ? kTwo : kOne;
}

inline FixedPressure nearestFixed(double pressure) {
  const double units = pressure / kFixedPressureUnit;
  return static_cast<FixedPressure>(units < 0 ? units - 0.5 : units + 0.5);
}

// Sums over a window of 2 half + 1 values, cut off at the ends.
std::vector<double> boxSums(const std::vector<double>& values, std::size_t half) {
  std::vector<double> prefix(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) prefix[i + 1] = prefix[i] + values[i];
  std::vector<double> sums(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    sums[i] = prefix[std::min(values.size(), i + half + 1)] - prefix[i - std::min(i, half)];
  }
  return sums;
}

}  // namespace

void HeldOutErrors::addSection(const CodeStatistics& held_out, const std::vector<double>& pressure) {
  std::vector<Errors> section;
  section.reserve(held_out.codes());
  held_out.forEach([&](const CodeSums& sums) {
    const FixedPressure answer = nearestFixed(pressure[sums.code]);
    if (sums.count == 1) {
      section.push_back({sums.code, 1.0, fromFixed(sums.sum - answer), 0.0});
      return;
    }
    // sum of (p - f)^2 = sum of p^2 - 2 f sum of p + n f^2: exact in integers
    const Int128 error = Int128{sums.sum} - Int128{answer} * sums.count;
    const Int128 squares =
        sums.sum_of_squares - Int128{answer} * (2 * Int128{sums.sum} - Int128{answer} * sums.count);
    const double mean = static_cast<double>(error) / sums.count;
    const double variance = std::max(0.0, static_cast<double>(squares) / sums.count - mean * mean);
    section.push_back({sums.code, static_cast<double>(sums.count), mean * kFixedPressureUnit,
                       std::sqrt(variance) * kFixedPressureUnit});
  });
  sections_.push_back(std::move(section));
}

bool HeldOutErrors::empty() const {
  return std::all_of(sections_.begin(), sections_.end(), [](const auto& section) { return section.empty(); });
}

template <typename Visit>
void HeldOutErrors::forEach(std::size_t left_out, Visit visit) const {
  for (std::size_t section = 0; section < sections_.size(); ++section) {
    if (section == left_out) continue;
    for (const Errors& errors : sections_[section]) visit(errors);
  }
}

HeldOutErrors::Sums HeldOutErrors::sums(std::size_t left_out) const {
  Sums sums{std::vector<double>(codes_, 0.0), std::vector<double>(codes_, 0.0)};
  forEach(left_out, [&](const Errors& errors) {
    sums.count[errors.code] += errors.count;
    sums.squares[errors.code] += errors.count * (errors.mean * errors.mean + errors.spread * errors.spread);
  });
  return sums;
}

std::vector<double> HeldOutErrors::rootMeanSquare(const Sums& sums, std::size_t window) const {
  const double all_count = std::accumulate(sums.count.begin(), sums.count.end(), 0.0);
  const double all_squares = std::accumulate(sums.squares.begin(), sums.squares.end(), 0.0);
  const double pooled = all_count > 0 ? all_squares / all_count : 0.0;
  const std::vector<double> near_count = boxSums(sums.count, window);
  const std::vector<double> near_squares = boxSums(sums.squares, window);
  std::vector<double> root(codes_);
  for (std::size_t code = 0; code < codes_; ++code) {
    // rounding can make a difference of prefix sums negative
    const double near = (std::max(0.0, near_squares[code]) + kPriorOfDeviation * pooled) /
                        (near_count[code] + kPriorOfDeviation);
    root[code] = (sums.squares[code] + kPriorOfDeviation * near) / (sums.count[code] + kPriorOfDeviation);
  }
  for (double& square : root) square = std::sqrt(square);
  return root;
}

// The factor of `root` at each code.
std::vector<double> HeldOutErrors::scale(const Sums& sums, const std::vector<double>& root,
                                         std::size_t left_out) const {
  DeviationScale scale(sums.count);
  forEach(left_out, [&](const Errors& errors) {
    const double unit = std::max(root[errors.code], kLeastDeviation);
    const std::vector<double>& points = pointsOf(errors.count);
    const double weight = errors.count / static_cast<double>(points.size());
    for (const double point : points) {
      scale.add(errors.code, (errors.mean + point * errors.spread) / unit, weight);
    }
  });
  return scale.factors();
}

std::vector<float> HeldOutErrors::deviation(const std::vector<double>& pressure, std::size_t left_out) const {
  std::size_t lowest = codes_ - 1, highest = 0;
  forEach(left_out, [&](const Errors& errors) {
    lowest = std::min<std::size_t>(lowest, errors.code);
    highest = std::max<std::size_t>(highest, errors.code);
  });
  lowest = std::min(lowest, highest);  // if there was no error at all
  const auto window = std::max<std::size_t>(
      1, static_cast<std::size_t>(kNeighbourhood * static_cast<double>(highest - lowest)));
  const Sums of_codes = sums(left_out);
  const std::vector<double> root = rootMeanSquare(of_codes, window);
  const std::vector<double> factor = scale(of_codes, root, left_out);

  std::vector<float> deviation(codes_);
  for (std::size_t code = 0; code < codes_; ++code) {
    const std::size_t below = std::max(lowest, code - std::min(code, window));
    const std::size_t above = std::min(highest, code + window);
    const double step = above > below
                            ? std::abs(pressure[above] - pressure[below]) / static_cast<double>(above - below)
                            : 0.0;
    deviation[code] = static_cast<float>(std::max({factor[code] * root[code], step, kLeastDeviation}));
  }
  return deviation;
}

namespace {

CodeHistogram histogramOf(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale) {
  CodeHistogram all(full_scale);
  for (const CodeStatistics& section : sections) all.add(section);
  return all;
}

CodeTable tableOf(const Fit& fit, const CodeHistogram& training) {
  CodeTable table;
  table.pressure.assign(fit.pressure.begin(), fit.pressure.end());
  table.support.assign(fit.support.begin(), fit.support.end());
  const auto occurs = [](std::int64_t count) { return count != 0; };
  const auto& count = training.count();
  const auto first = std::find_if(count.begin(), count.end(), occurs);
  const auto last = std::find_if(count.rbegin(), count.rend(), occurs);
  table.lowest = static_cast<std::uint16_t>(first - count.begin());
  table.highest = static_cast<std::uint16_t>(count.rend() - last - 1);
  return table;
}

}  // namespace

CrossValidatedModel assembleModel(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Fit& whole, std::vector<std::vector<double>> held_out,
                                  HeldOutDeviation held_out_deviation) {
  CrossValidatedModel model{tableOf(whole, histogramOf(sections, full_scale)),
                            std::vector<HeldOutModel>(sections.size())};
  HeldOutErrors errors(full_scale);
  for (std::size_t section = 0; section < sections.size(); ++section) {
    model.held_out[section].pressure = std::move(held_out[section]);
    const bool trained = !model.held_out[section].pressure.empty();
    errors.addSection(trained ? sections[section] : CodeStatistics{}, model.held_out[section].pressure);
  }
  if (errors.empty()) {
    for (const CodeStatistics& section : sections) errors.addSection(section, whole.pressure);
  }
  model.table.deviation = errors.deviation(whole.pressure);
  if (held_out_deviation == HeldOutDeviation::kNo) return model;
  for (std::size_t section = 0; section < sections.size(); ++section) {
    HeldOutModel& without = model.held_out[section];
    if (!without.pressure.empty()) without.deviation = errors.deviation(without.pressure, section);
  }
  return model;
}

}  // namespace fsr::regression
