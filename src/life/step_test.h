#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace fsr::life {

/// Why a value was not tested.
enum class Untested {
  kNo,         ///< it was tested
  kNoValue,    ///< it is NaN
  kTooFew,     ///< fewer than three values before it: their scatter is not known
  kNoScatter,  ///< the values before it lie on a line exactly, e.g. whole counts without noise
};

/// One value of a course, compared with the values before it.
struct Step {
  Untested untested = Untested::kTooFew;
  double predicted = std::numeric_limits<double>::quiet_NaN();
  double half_width = std::numeric_limits<double>::quiet_NaN();  ///< of the prediction interval
  double p = std::numeric_limits<double>::quiet_NaN();           ///< two-sided
  bool changed = false;                                          ///< p < level
};

/// Which values of a course changed suddenly.
struct StepTests {
  std::vector<Step> steps;  ///< one for each value
  /// The comparison that a value will have which follows the last one after `next`, without that value: its
  /// half-width is the smallest sudden change that would be found there.
  Step next;
};

/// Tests each value y_k against the values before it. These are taken as a line in time with scatter,
///
///   y_i = a + b t_i + e_i,   e_i independent, normal, of one variance,
///
/// where b is slow wear or drift. With n the number of earlier values, t' their mean time and s^2 the
/// variance of their residuals,
///
///   (y_k - a^ - b^ t_k) / (s sqrt(1 + 1/n + (t_k - t')^2 / sum (t_i - t')^2))
///
/// has Student's t distribution with n - 2 degrees of freedom. y_k changed where its two-sided p is below
/// `level`. This is the prediction interval of regression (N. Draper, H. Smith, Applied Regression Analysis,
/// 1998, sec. 3.2; R: predict(lm(y ~ t), interval = "prediction")). A value that changed begins a new course,
/// without the values before it. If it kept their scatter, a false finding would bring others: it is most
/// likely where the scatter is underestimated.
///
/// Where the model holds, each test finds a change with a probability of at most `level`, whatever the number
/// of values: with few of them the interval is wide instead. An undetected change among the earlier values
/// widens it, too. `time` ascends; a y that is NaN is left out. `level`: in (0, 1). `next`: time from the
/// last value to the one that will follow.
StepTests testSteps(const std::vector<double>& time, const std::vector<double>& y, double level,
                    double next = 0);

}  // namespace fsr::life
