#include "fsr_pressure_map/regression/held_out_deviation.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/regression/deviation_scale.h"

namespace fsr {

namespace {

// A code's own errors weigh as much as its neighbourhood's where it has this many readings, and the
// neighbourhood's as much as those of all codes.
constexpr double kPriorReadings = 30.0;
// Half width of a neighbourhood, as a share of the codes that occur: narrow beside the bends of a
// sensor's curve, wide enough to hold a hundred readings of a recording of ten minutes at 10 Hz.
constexpr double kNeighbourhood = 1.0 / 64.0;
constexpr double kLeastDeviation = 1.0;  // [Pa]

// Readings of one code in one section are known by number, mean and spread. They stand for these points,
// in units of the spread: two readings lie at mean +- spread, more are taken for normal (the quantiles of
// 1/12, 3/12 ... 11/12, stretched to unit variance).
const std::vector<double> kOne = {0.0};
const std::vector<double> kTwo = {-1.0, 1.0};
const std::vector<double> kMore = {-1.54242, -0.75224, -0.23469, 0.23469, 0.75224, 1.54242};

const std::vector<double>& pointsOf(double count) {
  return count > 2 ? kMore : count > 1 ? kTwo : kOne;
}

// Sums over a box of 2 half + 1 values, cut at the ends.
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
    // sum of (p - f)^2 = sum of p^2 - 2 f sum of p + n f^2: exact in integers
    const FixedPressure answer = std::llround(pressure[sums.code] / kFixedPressureUnit);
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

std::vector<double> HeldOutErrors::rootMeanSquare(std::size_t left_out, std::size_t window) const {
  std::vector<double> count(codes_, 0.0), squares(codes_, 0.0);
  double all_count = 0, all_squares = 0;
  forEach(left_out, [&](const Errors& errors) {
    const double square = errors.count * (errors.mean * errors.mean + errors.spread * errors.spread);
    count[errors.code] += errors.count;
    squares[errors.code] += square;
    all_count += errors.count;
    all_squares += square;
  });
  const double pooled = all_count > 0 ? all_squares / all_count : 0.0;
  const std::vector<double> near_count = boxSums(count, window);
  const std::vector<double> near_squares = boxSums(squares, window);
  std::vector<double> root(codes_);
  for (std::size_t code = 0; code < codes_; ++code) {
    // a difference of prefix sums can come out a rounding below zero
    const double near =
        (std::max(0.0, near_squares[code]) + kPriorReadings * pooled) / (near_count[code] + kPriorReadings);
    root[code] = std::sqrt((squares[code] + kPriorReadings * near) / (count[code] + kPriorReadings));
  }
  return root;
}

// The factor on `root` at each code.
std::vector<double> HeldOutErrors::scale(const std::vector<double>& root, std::size_t left_out) const {
  std::vector<double> count(codes_, 0.0);
  forEach(left_out, [&](const Errors& errors) { count[errors.code] += errors.count; });
  DeviationScale scale(count);
  forEach(left_out, [&](const Errors& errors) {
    const double unit = std::max(root[errors.code], kLeastDeviation);
    const std::vector<double>& points = pointsOf(errors.count);
    for (const double point : points) {
      scale.add(errors.code, (errors.mean + point * errors.spread) / unit,
                errors.count / static_cast<double>(points.size()));
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
  lowest = std::min(lowest, highest);  // where there was no error at all
  const auto window = std::max<std::size_t>(
      1, static_cast<std::size_t>(kNeighbourhood * static_cast<double>(highest - lowest)));
  const std::vector<double> root = rootMeanSquare(left_out, window);
  const std::vector<double> factor = scale(root, left_out);

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

}  // namespace fsr
