#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fsr::statistics {

/// Several treatments (algorithms, methods) measured on the same units (taxels, cycles):
/// values[treatment][unit], all in the same unit of measure.
struct RepeatedMeasures {
  std::vector<std::string> treatments;
  std::vector<std::vector<double>> values;

  std::size_t units() const { return values.empty() ? 0 : values.front().size(); }
};

/// Throws InputError unless every value is finite and there are at least `fewest` of them. R silently drops
/// missing values; here the caller decides which units to leave out. `test`: name of the test for the
/// message.
void requireSample(const std::vector<double>& values, std::size_t fewest, const std::string& test);

/// Throws InputError unless there are at least `fewest_treatments` treatments with a name each and finite
/// values on the same units, at least `fewest_units` of them.
void requireMeasures(const RepeatedMeasures& measures, std::size_t fewest_treatments,
                     std::size_t fewest_units, const std::string& test);

/// first - second, unit by unit. InputError where lengths differ or a value is not finite.
std::vector<double> pairedDifferences(const std::vector<double>& first, const std::vector<double>& second,
                                      const std::string& test);

/// Arithmetic mean; `values` is not empty.
double meanOf(const std::vector<double>& values);

/// Sum of squared deviations from the mean.
double squaredDeviations(const std::vector<double>& values);

/// Whether `values` differ by rounding errors only (range within 10 machine epsilons of the largest
/// magnitude). For such a sample no statistic that is divided by a deviation has a meaning.
bool isConstant(const std::vector<double>& values);

}  // namespace fsr::statistics
