#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace fsr::statistics {

/// Standard deviation of normally distributed numbers of mean 0 / median of their absolute values.
constexpr double kDeviationPerMedian = 1.4826;

/// Upper median: element n / 2 (counted from 0) of the n sorted values. For an even number of values this is
/// the larger of the two in the middle, so the result is always one of the values. `of_none`: the result
/// where there are no values. No value may be NaN.
double upperMedian(std::vector<double> values, double of_none = std::numeric_limits<double>::quiet_NaN());

/// Mean and scatter of values that come one after another (B. P. Welford, Technometrics 4, 1962).
struct RunningMoments {
  double count = 0, mean = 0;
  double squares = 0;  ///< sum of squared differences from the mean

  void add(double value) {
    const double step = value - mean;
    count += 1;
    mean += step / count;
    squares += step * (value - mean);
  }

  /// As if the values of `other` had been added (T. F. Chan, G. H. Golub, R. J. LeVeque, COMPSTAT 1982).
  void merge(const RunningMoments& other) {
    if (other.count == 0) return;
    const double step = other.mean - mean, share = other.count / (count + other.count);
    squares += other.squares + step * step * count * share;
    mean += step * share;
    count += other.count;
  }

  /// With the divisor n - 1; 0 for fewer than two values.
  double deviation() const { return count > 1 ? std::sqrt(squares / (count - 1)) : 0.0; }
};

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
