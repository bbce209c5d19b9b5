#include "discrepancy/samples/require_reference.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/thresholds.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr double kMoves = 0.5;  // share of the largest change of readings: the sheet was loaded
// Correlations of the mean reading with the pressure. A force sensitive resistor has more than 0.9, the
// friction of a piston about 0.
constexpr double kFollows = -0.3;
constexpr double kFalls = -0.9;

// Pressure and mean reading of one recording, over its samples.
struct Course {
  std::vector<double> pressure, reading;

  static double range(const std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
  }
  double correlation() const;
};

double Course::correlation() const {
  const double p = statistics::meanOf(pressure), r = statistics::meanOf(reading);
  double pp = 0, rr = 0, pr = 0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    pp += (pressure[i] - p) * (pressure[i] - p);
    rr += (reading[i] - r) * (reading[i] - r);
    pr += (pressure[i] - p) * (reading[i] - r);
  }
  return pp > 0 && rr > 0 ? pr / std::sqrt(pp * rr) : 0;
}

std::vector<Course> coursesOf(const Measured& measured) {
  std::vector<Course> courses(measured.recordings->size());
  std::vector<double> readings;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    measured.recorded(i, readings);
    double sum = 0;
    for (std::size_t t = 0; t < readings.size(); ++t) sum += measured.used[t] * readings[t];
    Course& course = courses[measured.visits[measured.visit[i]].recording];
    course.pressure.push_back(measured.pressure[i]);
    course.reading.push_back(sum);
  }
  return courses;
}

}  // namespace

void requireReference(const Measured& measured) {
  const auto refuse = [&](std::size_t recording, const std::string& why) {
    throw settings::InputError((*measured.recordings)[recording].name + ": " + why);
  };
  const std::vector<Course> courses = coursesOf(measured);
  double most = 0;
  for (const Course& course : courses) most = std::max(most, Course::range(course.reading));
  for (std::size_t r = 0; r < courses.size(); ++r) {
    const double range = Course::range(courses[r].pressure);
    if (range < thresholds::kLeastRange) {
      if (Course::range(courses[r].reading) <= kMoves * most) continue;  // at rest
      refuse(r, "chamber pressure covers " + settings::roundedText(range * 1e-3) +
                    " kPa, but its readings change as if it were much more; chamber_pressure must be in Pa "
                    "and come from a transducer on the chamber");
    }
    const double correlation = courses[r].correlation();
    if (correlation < kFalls)
      refuse(r,
             "its readings fall while the chamber pressure rises, but must rise with it; record full scale "
             "minus counts");
    if (correlation < kFollows)
      refuse(r, "its readings do not follow the chamber pressure (correlation " +
                    settings::fixedText(correlation, 2) +
                    "); the sheet must lie in the chamber, and both stamps must come from one clock");
  }
}

}  // namespace fsr::discrepancy
