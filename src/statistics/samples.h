#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fsr::statistics {

/// Several treatments (algorithms, methods) measured on the same units (taxels, cycles):
/// values[treatment][unit], any unit of measure, the same in all.
struct RepeatedMeasures {
  std::vector<std::string> treatments;
  std::vector<std::vector<double>> values;

  std::size_t units() const { return values.empty() ? 0 : values.front().size(); }
};

/// Throws InputError unless every value is finite and there are at least `fewest` of them. R drops
/// missing values in silence; here the caller decides which unit to leave out, and says so. `test`
/// names the asker in the sentence.
void requireSample(const std::vector<double>& values, std::size_t fewest, const std::string& test);

/// Throws InputError unless there are at least `fewest_treatments`, one name each, every one finite on
/// the same units, at least `fewest_units` of them.
void requireMeasures(const RepeatedMeasures& measures, std::size_t fewest_treatments,
                     std::size_t fewest_units, const std::string& test);

/// first - second, unit by unit. InputError where lengths differ or a value is not finite.
std::vector<double> pairedDifferences(const std::vector<double>& first, const std::vector<double>& second,
                                      const std::string& test);

/// Arithmetic mean; `values` is not empty.
double meanOf(const std::vector<double>& values);

/// Sum of squared deviations from the mean.
double squaredDeviations(const std::vector<double>& values);

/// Whether `values` scatter no more than rounding does (range within 10 machine epsilons of the largest
/// magnitude): a sample on which nothing divided by a deviation has a meaning.
bool isConstant(const std::vector<double>& values);

}  // namespace fsr::statistics
