#include "dataset/paces.h"

#include <algorithm>
#include <cmath>

#include "dataset/sections.h"

namespace fsr::dataset {

namespace {

constexpr double kRateWindow = 2;  // over which the rate of pressure is found [s]

}  // namespace

std::vector<double> pressureRates(const Recording& recording) {
  const std::size_t n = recording.scans();
  std::vector<double> rate(n, 0);
  std::size_t first = 0, last = 0;
  double count = 0, t = 0, p = 0, tt = 0, tp = 0;
  const auto add = [&](std::size_t i, double weight) {
    // Relative to the first scan, so that the sums keep their digits.
    const double time = recording.time[i] - recording.time[0];
    count += weight, t += weight * time, p += weight * recording.pressure[i];
    tt += weight * time * time, tp += weight * time * recording.pressure[i];
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (i == 0 || recording.condition[i] != recording.condition[i - 1]) {
      first = last = i;
      count = t = p = tt = tp = 0;
    }
    while (last < n && recording.condition[last] == recording.condition[i] &&
           recording.time[last] <= recording.time[i] + kRateWindow / 2) {
      add(last++, 1);
    }
    while (recording.time[first] < recording.time[i] - kRateWindow / 2) add(first++, -1);
    const double spread = tt - t * t / count;
    rate[i] = spread > 1e-9 ? (tp - t * p / count) / spread : 0;
  }
  return rate;
}

std::vector<std::uint8_t> dwellsOf(const Recording& recording) {
  std::vector<std::uint8_t> dwells(recording.scans(), 0);
  const auto finite = [](double pressure) { return std::isfinite(pressure); };
  if (!std::all_of(recording.pressure.begin(), recording.pressure.end(), finite)) return dwells;
  const std::vector<double> rate = pressureRates(recording);
  double fastest = 0, highest = 0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    fastest = std::max(fastest, std::abs(rate[i]));
    highest = std::max(highest, recording.pressure[i]);
  }
  const auto holds = [&](std::size_t i) {
    return std::abs(rate[i]) <= kStill * fastest && recording.pressure[i] > kLoaded * highest;
  };
  for (std::size_t first = 0; first < rate.size(); ++first) {
    if (!holds(first)) continue;
    std::size_t last = first;
    while (last + 1 < rate.size() && recording.condition[last + 1] == recording.condition[first] &&
           holds(last + 1)) {
      ++last;
    }
    if (recording.time[last] - recording.time[first] >= kLeastDwell)
      std::fill(dwells.begin() + std::ptrdiff_t(first), dwells.begin() + std::ptrdiff_t(last) + 1, 1);
    first = last;
  }
  return dwells;
}

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
