#include "calibration/history_errors.h"

#include <algorithm>
#include <cmath>

#include "calibration/history_parts.h"

namespace fsr::calibration {

namespace {

constexpr double kWithin = 0.682689492;  // of a normal distribution within one deviation
constexpr double kSmallest = 1e-6;       // of the absolute errors that are told apart, share of `highest`

}  // namespace

HistoryErrors::HistoryErrors(double highest) : highest_(highest), parts_(kHistoryParts) {}

std::size_t HistoryErrors::bin(const Reading& reading) const {
  const double at = reading.answer / highest_ * static_cast<double>(kBins);
  const auto place = static_cast<std::size_t>(std::min(std::max(at, 0.0), static_cast<double>(kBins - 1)));
  return place + (reading.unloading ? kBins : 0);
}

// Upper end of a level [Pa].
double HistoryErrors::level(std::size_t number) const {
  return highest_ * kSmallest *
         std::pow(1 / kSmallest, static_cast<double>(number + 1) / static_cast<double>(kLevels - 1));
}

void HistoryErrors::add(const Reading& reading) {
  const double before = reading.static_answer - reading.truth, error = reading.answer - reading.truth;
  const double share = std::max(std::abs(error) / (highest_ * kSmallest), 1.0);
  const double at = std::log(share) / std::log(1 / kSmallest) * static_cast<double>(kLevels - 1);
  const auto place = static_cast<std::size_t>(std::min(at, static_cast<double>(kLevels - 1)));
  const std::size_t own = bin(reading);
  const std::array<std::size_t, 3> parts = historyPartsOf(reading.direction, reading.since_reversal);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k > 0 && parts[k] == parts[k - 1]) continue;
    Sum& sum = parts_[parts[k]];
    ++sum.readings;
    sum.static_square += before * before;
    sum.square += error * error;
    ++sum.errors[own][place];
  }
}

void HistoryErrors::merge(const HistoryErrors& other) {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    parts_[p].readings += other.parts_[p].readings;
    parts_[p].static_square += other.parts_[p].static_square;
    parts_[p].square += other.parts_[p].square;
    for (std::size_t b = 0; b < 2 * kBins; ++b) {
      for (std::size_t l = 0; l < kLevels; ++l) parts_[p].errors[b][l] += other.parts_[p].errors[b][l];
    }
  }
}

// NaN for a bin without readings.
double HistoryErrors::quantile(std::size_t bin) const {
  const auto& errors = parts_[0].errors[bin];
  std::uint64_t all = 0, below = 0;
  for (const std::uint64_t count : errors) all += count;
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t l = 0; l < kLevels; ++l) {
    below += errors[l];
    if (static_cast<double>(below) >= kWithin * static_cast<double>(all)) return level(l);
  }
  return level(kLevels - 1);
}

std::vector<double> HistoryErrors::deviation(std::size_t first_bin) const {
  std::vector<double> deviation;
  for (std::size_t b = 0; b < kBins; ++b) deviation.push_back(quantile(first_bin + b));
  for (std::size_t b = 1; b < kBins; ++b)
    if (std::isnan(deviation[b])) deviation[b] = deviation[b - 1];
  for (std::size_t b = kBins - 1; b-- > 0;)
    if (std::isnan(deviation[b])) deviation[b] = deviation[b + 1];
  return deviation;
}

void HistoryErrors::setDeviation(compensation::HistoryModel& model) const {
  const double width = highest_ / static_cast<double>(kBins);
  model.deviation_knot.clear();
  for (std::size_t b = 0; b < kBins; ++b)
    model.deviation_knot.push_back((static_cast<double>(b) + 0.5) * width);
  model.loading_deviation = deviation(0);
  model.unloading_deviation = deviation(kBins);
  // Readings of one direction only: nothing else is known of the other one.
  if (std::isnan(model.loading_deviation.front())) model.loading_deviation = model.unloading_deviation;
  if (std::isnan(model.unloading_deviation.front())) model.unloading_deviation = model.loading_deviation;
}

std::vector<HistoryScore::Part> HistoryErrors::parts() const {
  std::vector<HistoryScore::Part> parts;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const Sum& sum = parts_[p];
    if (sum.readings == 0) continue;
    const double readings = static_cast<double>(sum.readings);
    std::uint64_t within = 0;
    for (std::size_t b = 0; b < 2 * kBins; ++b) {
      const double deviation = quantile(b);
      for (std::size_t l = 0; l < kLevels && level(l) <= deviation; ++l) within += sum.errors[b][l];
    }
    parts.push_back({historyPartName(p), sum.readings, std::sqrt(sum.static_square / readings),
                     std::sqrt(sum.square / readings), static_cast<double>(within) / readings});
  }
  return parts;
}

}  // namespace fsr::calibration
