#include "discrepancy/samples/measured.h"

#include <algorithm>
#include <cmath>

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

// The reference pressure scatters by about one transducer step from scan to scan. Its slope scatters much
// more. The chamber pressure consists of ramps and dwells, so straight lines through a few scans remove the
// scatter. Beside a corner the line must lie on one side of it. M. Kuwahara et al., 1976, do the same for
// images.

namespace {

constexpr std::size_t kScans = 9;  // in one line
constexpr double kLongestGap = 5;  // longest mean time between two scans of one line [s]
constexpr double kStraight = 3;    // largest scatter about a straight line, in units of the usual scatter

// A straight line through kScans scans. `time` and `pressure` are the means over these scans.
struct Line {
  double time = 0, pressure = 0, slope = 0;
  double scatter = 0;  // rms deviation of the scans from the line [Pa]

  double at(double t) const { return pressure + slope * (t - time); }
};

Line lineThrough(const std::vector<double>& time, const std::vector<double>& pressure, std::size_t first) {
  Line line;
  for (std::size_t i = first; i < first + kScans; ++i) {
    line.time += time[i] / kScans;
    line.pressure += pressure[i] / kScans;
  }
  double tt = 0, tp = 0;
  for (std::size_t i = first; i < first + kScans; ++i) {
    tt += (time[i] - line.time) * (time[i] - line.time);
    tp += (time[i] - line.time) * (pressure[i] - line.pressure);
  }
  line.slope = tt > 0 ? tp / tt : 0;
  for (std::size_t i = first; i < first + kScans; ++i) {
    line.scatter += std::pow(pressure[i] - line.at(time[i]), 2);
  }
  line.scatter = std::sqrt(line.scatter / (kScans - 2));
  const bool gap = time[first + kScans - 1] - time[first] > kLongestGap * kScans;
  if (gap) line.scatter = INFINITY;
  return line;
}

double plainSlope(const std::vector<double>& time, const std::vector<double>& pressure, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, time.size() - 1);
  return time[after] > time[before] ? (pressure[after] - pressure[before]) / (time[after] - time[before]) : 0;
}

}  // namespace

std::vector<double> smoothCourse(const std::vector<double>& time, const std::vector<double>& pressure,
                                 std::vector<double>& rate) {
  std::vector<double> smooth = pressure;
  rate.resize(time.size());
  for (std::size_t i = 0; i < time.size(); ++i) rate[i] = plainSlope(time, pressure, i);
  if (time.size() < kScans) return smooth;
  std::vector<Line> lines;
  std::vector<double> scatters;
  for (std::size_t first = 0; first + kScans <= time.size(); ++first) {
    lines.push_back(lineThrough(time, pressure, first));
    scatters.push_back(lines.back().scatter);
  }
  const double most = kStraight * statistics::upperMedian(scatters, 0) + 1e-9;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::size_t from = i >= kScans - 1 ? i - (kScans - 1) : 0, to = std::min(i, lines.size() - 1);
    const auto best = std::min_element(lines.begin() + static_cast<std::ptrdiff_t>(from),
                                       lines.begin() + static_cast<std::ptrdiff_t>(to) + 1,
                                       [](const Line& a, const Line& b) { return a.scatter < b.scatter; });
    if (best->scatter > most) continue;
    smooth[i] = best->at(time[i]);
    rate[i] = best->slope;
  }
  return smooth;
}

}  // namespace fsr::discrepancy
