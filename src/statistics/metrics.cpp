#include "fsr_pressure_map/statistics/metrics.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "statistics/samples.h"

namespace fsr::statistics {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormal95 = 1.959963984540054;  // scipy.stats.norm.ppf(0.975)

double squaresAbout(const std::vector<double>& values, double centre) {
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum;
}

double squaredErrors(const std::vector<double>& predicted, const std::vector<double>& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    sum += (predicted[i] - reference[i]) * (predicted[i] - reference[i]);
  }
  return sum;
}

double sampleDeviation(const std::vector<double>& values, double mean) {
  if (values.size() < 2) return kNone;
  return std::sqrt(squaresAbout(values, mean) / static_cast<double>(values.size() - 1));
}

}  // namespace

double rSquared(const std::vector<double>& predicted, const std::vector<double>& reference) {
  if (reference.size() < 2) return kNone;
  const double total = squaresAbout(reference, meanOf(reference));
  return total > 0 ? 1.0 - squaredErrors(predicted, reference) / total : kNone;
}

double rmsePercent(const std::vector<double>& predicted, const std::vector<double>& reference) {
  if (reference.empty()) return kNone;
  const auto [low, high] = std::minmax_element(reference.begin(), reference.end());
  const double range = *high - *low;
  if (!(range > 0)) return kNone;
  const double mean_square = squaredErrors(predicted, reference) / static_cast<double>(reference.size());
  return 100.0 * std::sqrt(mean_square) / range;
}

double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return kNone;
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end());
  const auto above = std::min_element(below + 1, values.end());
  const double fraction = place - std::floor(place);
  return above == values.end() || fraction == 0 ? *below : *below + fraction * (*above - *below);
}

ErrorSummary summariseErrors(const std::vector<double>& errors) {
  ErrorSummary summary;
  summary.count = errors.size();
  if (errors.empty()) return summary;
  summary.bias = meanOf(errors);
  summary.rmse = std::sqrt(squaresAbout(errors, 0.0) / static_cast<double>(errors.size()));
  const double deviation = sampleDeviation(errors, summary.bias);
  summary.limit_low = summary.bias - kNormal95 * deviation;
  summary.limit_high = summary.bias + kNormal95 * deviation;
  std::vector<double> absolute(errors.size());
  std::transform(errors.begin(), errors.end(), absolute.begin(),
                 [](double error) { return std::abs(error); });
  summary.p95_absolute = quantile(absolute, 0.95);
  return summary;
}

Spread spreadOf(const std::vector<double>& values) {
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](double value) { return !std::isnan(value); });
  if (known.empty()) return {};
  const double mean = meanOf(known);
  return {mean, sampleDeviation(known, mean)};
}

std::size_t pressureBin(double pressure) {
  const auto above = std::upper_bound(kPressureBinEdges.begin() + 1, kPressureBinEdges.end(), pressure);
  return static_cast<std::size_t>(above - kPressureBinEdges.begin()) - 1;
}

std::string pressureBinName(std::size_t bin, double unit) {
  const auto text = [&](double edge) { return std::to_string(std::lround(edge / unit)); };
  const std::string low = text(kPressureBinEdges.at(bin));
  return bin + 1 == kPressureBins ? low + "+" : low + "-" + text(kPressureBinEdges[bin + 1]);
}

}  // namespace fsr::statistics
