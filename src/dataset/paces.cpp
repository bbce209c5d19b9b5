#include "dataset/paces.h"

#include <algorithm>
#include <cmath>

#include "dataset/cycles.h"
#include "dataset/pressure_rate.h"

namespace fsr::dataset {

namespace {

// Adds the cycles among the scans `from` .. `to` - 1, all on one surface.
void addCourses(const Recording& recording, const std::vector<double>& rates, std::size_t from,
                std::size_t to, const CourseScale& scale, std::vector<CycleCourse>& courses) {
  const auto at = [&](std::size_t i) { return recording.pressure.begin() + static_cast<std::ptrdiff_t>(i); };
  const Cycles cycles = findCycles({at(from), at(to)});
  for (std::size_t c = 0; c < cycles.count(); ++c) {
    const std::size_t first = from + cycles.first[c];
    const std::size_t end = c + 1 < cycles.count() ? from + cycles.first[c + 1] : to;
    courses.push_back(
        courseOf(&recording.time[first], &recording.pressure[first], &rates[first], end - first, scale));
  }
}

std::vector<CycleCourse> coursesOf(const std::vector<Recording>& recordings) {
  CourseScale scale;
  std::vector<std::vector<double>> rates;
  for (const Recording& recording : recordings) {
    rates.push_back(pressureRates(recording));
    for (const double rate : rates.back()) scale.fastest = std::max(scale.fastest, std::abs(rate));
    for (const double pressure : recording.pressure) scale.highest = std::max(scale.highest, pressure);
  }
  std::vector<CycleCourse> courses;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const Recording& recording = recordings[r];
    for (std::size_t from = 0, to = 0; from < recording.scans(); from = to) {
      while (to < recording.scans() && recording.condition[to] == recording.condition[from]) ++to;
      addCourses(recording, rates[r], from, to, scale, courses);
    }
  }
  return courses;
}

bool isAmong(const std::vector<CycleCourse>& paces, const CycleCourse& course) {
  const auto near = [](double a, double b, double factor) { return a <= factor * b && b <= factor * a; };
  return std::any_of(paces.begin(), paces.end(), [&](const CycleCourse& pace) {
    return near(pace.speed, course.speed, kOtherSpeed) && near(pace.dwell, course.dwell, kOtherDwell) &&
           near(pace.peak, course.peak, kOtherPeak);
  });
}

}  // namespace

std::vector<CycleCourse> pacesOf(const std::vector<Recording>& recordings) {
  std::vector<CycleCourse> paces;
  for (const CycleCourse& course : coursesOf(recordings)) {
    if (!isAmong(paces, course)) paces.push_back(course);
  }
  return paces;
}

bool havePaces(const std::vector<Recording>& recordings, const std::vector<CycleCourse>& paces) {
  const std::vector<CycleCourse> courses = coursesOf(recordings);
  const auto among = std::count_if(courses.begin(), courses.end(),
                                   [&](const CycleCourse& course) { return isAmong(paces, course); });
  return 2 * static_cast<std::size_t>(among) > courses.size();
}

}  // namespace fsr::dataset
