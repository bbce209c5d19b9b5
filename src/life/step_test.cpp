#include "life/step_test.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "statistics/samples.h"

namespace fsr::life {

namespace {

// A line in time with scatter, fitted to the values since the last change.
class Course {
 public:
  void add(double time, double y) {
    time_.push_back(time);
    y_.push_back(y);
  }
  void clear() { *this = Course(); }
  double last() const { return time_.empty() ? 0 : time_.back(); }

  // Compares a value (NaN = none yet) with the prediction at its time.
  Step compare(double time, double y, double level) const {
    Step step;
    const auto n = static_cast<double>(y_.size());
    if (y_.size() < 3) return step;
    const double middle = statistics::meanOf(time_), mean = statistics::meanOf(y_);
    double tt = 0, ty = 0;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      tt += (time_[i] - middle) * (time_[i] - middle);
      ty += (time_[i] - middle) * (y_[i] - mean);
    }
    const double slope = ty / tt;
    double squares = 0, largest = 0;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      const double residual = y_[i] - mean - slope * (time_[i] - middle);
      squares += residual * residual;
      largest = std::max(largest, std::abs(y_[i]));
    }
    if (std::sqrt(squares / n) <= kRounding * largest) {
      step.untested = Untested::kNoScatter;
      return step;
    }
    const double error = std::sqrt(squares / (n - 2) * (1 + 1 / n + (time - middle) * (time - middle) / tt));
    const boost::math::students_t t(n - 2);
    step.untested = Untested::kNo;
    step.predicted = mean + slope * (time - middle);
    step.half_width = error * boost::math::quantile(boost::math::complement(t, level / 2));
    if (!std::isnan(y))
      step.p = 2 * boost::math::cdf(boost::math::complement(t, std::abs(y - step.predicted) / error));
    step.changed = step.p < level;  // false for NaN
    return step;
  }

 private:
  static constexpr double kRounding = 1e-12;  // residuals up to this share of the values are rounding

  std::vector<double> time_, y_;
};

}  // namespace

StepTests testSteps(const std::vector<double>& time, const std::vector<double>& y, double level,
                    double next) {
  StepTests tests;
  Course course;
  for (std::size_t i = 0; i < y.size(); ++i) {
    Step step;
    if (std::isnan(y[i])) {
      step.untested = Untested::kNoValue;
    } else {
      step = course.compare(time[i], y[i], level);
      if (step.changed) course.clear();
      course.add(time[i], y[i]);
    }
    tests.steps.push_back(step);
  }
  tests.next = course.compare(course.last() + next, NAN, level);
  return tests;
}

}  // namespace fsr::life
