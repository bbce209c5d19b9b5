#include "statistics/samples.h"

#include <algorithm>
#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::statistics {

double upperMedian(std::vector<double> values, double of_none) {
  if (values.empty()) return of_none;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

namespace {

[[noreturn]] void refuse(const std::string& test, const std::string& sentence) {
  throw settings::InputError(test + ": " + sentence);
}

std::string count(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

}  // namespace

void requireSample(const std::vector<double>& values, std::size_t fewest, const std::string& test) {
  if (values.size() < fewest) {
    refuse(test,
           count(values.size(), "value") + " given where at least " + std::to_string(fewest) + " are needed");
  }
  const auto bad = std::find_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); });
  if (bad != values.end()) {
    refuse(test, "value " + std::to_string(bad - values.begin() + 1) + " of " +
                     std::to_string(values.size()) + " is " + (std::isnan(*bad) ? "NaN" : "infinite") +
                     "; leave its unit out of every treatment");
  }
}

void requireMeasures(const RepeatedMeasures& measures, std::size_t fewest_treatments,
                     std::size_t fewest_units, const std::string& test) {
  const std::size_t k = measures.values.size();
  if (measures.treatments.size() != k) {
    refuse(test, count(measures.treatments.size(), "name") + " given for " + count(k, "treatment"));
  }
  if (k < fewest_treatments) {
    refuse(test, count(k, "treatment") + " given where at least " + std::to_string(fewest_treatments) +
                     " are needed");
  }
  for (std::size_t j = 0; j < k; ++j) {
    const std::string name = test + " of '" + measures.treatments[j] + "'";
    if (measures.values[j].size() != measures.units()) {
      refuse(name, count(measures.values[j].size(), "value") + " where '" + measures.treatments[0] +
                       "' has " + std::to_string(measures.units()) +
                       "; every treatment needs the same units");
    }
    requireSample(measures.values[j], fewest_units, name);
  }
}

std::vector<double> pairedDifferences(const std::vector<double>& first, const std::vector<double>& second,
                                      const std::string& test) {
  requireMeasures({{"first", "second"}, {first, second}}, 2, 1, test);
  std::vector<double> differences(first.size());
  std::transform(first.begin(), first.end(), second.begin(), differences.begin(), std::minus<>());
  return differences;
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squaredDeviations(const std::vector<double>& values) {
  const double mean = meanOf(values);
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [mean](double sum, double x) { return sum + (x - mean) * (x - mean); });
}

bool isConstant(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double magnitude = std::max(std::abs(*low), std::abs(*high));
  return *high - *low <= 10 * std::numeric_limits<double>::epsilon() * magnitude;
}

}  // namespace fsr::statistics
