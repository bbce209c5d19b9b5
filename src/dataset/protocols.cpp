#include "dataset/protocols.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "dataset/sections.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::dataset {

namespace {

constexpr double kLeastShare = 0.05;  // of the scans; a smaller group is no protocol

// One cycle of one recording.
struct Cycle {
  std::size_t recording = 0;
  std::vector<std::size_t> scans;  // in the order of time
};

std::vector<Cycle> cyclesOf(const std::vector<Recording>& recordings, const std::vector<Sections>& sections) {
  std::vector<Cycle> cycles;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> place;  // of condition and cycle
    for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
      if (sections[r].section[i] == kNoSection) continue;
      const auto [entry, fresh] =
          place.emplace(std::pair(recordings[r].condition[i], sections[r].cycle[i]), cycles.size());
      if (fresh) cycles.push_back({r, {}});
      cycles[entry->second].scans.push_back(i);
    }
  }
  return cycles;
}

// A feature of the course, and how a protocol is named by it.
struct Feature {
  double CycleCourse::*value;
  double factor;
  const char* before;
  const char* after;
  double unit;
};

const std::array<Feature, 3> kFeatures = {{{&CycleCourse::speed, kOtherSpeed, "ramps of ", " kPa/s", 1e3},
                                           {&CycleCourse::dwell, kOtherDwell, "dwells of ", " s", 1},
                                           {&CycleCourse::peak, kOtherPeak, "peaks of ", " kPa", 1e3}}};

// Groups where the feature jumps. Where it does not jump but varies by more than the factor between its lower
// and its upper tenth: two halves.
std::vector<std::vector<std::size_t>> groupsOf(const std::vector<double>& feature, double factor) {
  std::vector<std::vector<std::size_t>> groups = groupsByJump(feature, factor);
  if (groups.size() != 1 || groups.front().size() < 4) return groups;
  std::vector<std::size_t> order = groups.front();
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return feature[a] < feature[b]; });
  const std::size_t tenth = order.size() / 10, half = order.size() / 2;
  if (feature[order[order.size() - 1 - tenth]] <= factor * feature[order[tenth]]) return groups;
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(half);
  return {{order.begin(), middle}, {middle, order.end()}};
}

// The group of each cycle by each feature.
std::vector<std::array<std::size_t, 3>> keysOf(const std::vector<CycleCourse>& courses) {
  std::vector<std::array<std::size_t, 3>> keys(courses.size(), {0, 0, 0});
  for (std::size_t f = 0; f < kFeatures.size(); ++f) {
    std::vector<double> feature;
    for (const CycleCourse& course : courses) feature.push_back(course.*kFeatures[f].value);
    const auto groups = groupsOf(feature, kFeatures[f].factor);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (const std::size_t c : groups[g]) keys[c][f] = g + 1;
    }
  }
  return keys;
}

// The features in which the protocols differ, with the median of the group.
std::string nameOf(const std::vector<std::size_t>& members, const std::vector<CycleCourse>& courses,
                   const std::vector<std::array<std::size_t, 3>>& keys) {
  std::string name;
  for (std::size_t f = 0; f < kFeatures.size(); ++f) {
    const auto same = [&](const auto& key) { return key[f] == keys.front()[f]; };
    if (std::all_of(keys.begin(), keys.end(), same)) continue;
    std::vector<double> values;
    for (const std::size_t c : members) values.push_back(courses[c].*kFeatures[f].value / kFeatures[f].unit);
    name += (name.empty() ? "" : ", ") + std::string(kFeatures[f].before) +
            settings::roundedText(statistics::upperMedian(values, 0), 3) + kFeatures[f].after;
  }
  return name.empty() ? "all cycles" : name;
}

// The longest time at which the rate stays below kStill of the fastest [s].
double longestHold(const Recording& recording, const std::vector<double>& rate, double fastest) {
  double longest = 0, hold = 0;
  for (std::size_t i = 1; i < recording.scans(); ++i) {
    const bool goes_on = recording.condition[i] == recording.condition[i - 1] &&
                         std::abs(rate[i]) <= kStill * fastest && std::abs(rate[i - 1]) <= kStill * fastest;
    hold = goes_on ? hold + (recording.time[i] - recording.time[i - 1]) : 0;
    longest = std::max(longest, hold);
  }
  return longest;
}

}  // namespace

CycleCourse courseOf(const double* time, const double* pressure, const double* rate, std::size_t scans,
                     const CourseScale& scale) {
  CycleCourse course;
  std::vector<double> speeds;
  for (std::size_t i = 0; i < scans; ++i) {
    course.peak = std::max(course.peak, pressure[i]);
    const double speed = std::abs(rate[i]);
    if (speed > kStill * scale.fastest) speeds.push_back(speed);
    const bool holds = speed <= kStill * scale.fastest && pressure[i] > kLoaded * scale.highest;
    if (holds && i + 1 < scans) course.dwell += time[i + 1] - time[i];
  }
  course.speed = statistics::upperMedian(std::move(speeds), 0);
  course.dwell = std::max(course.dwell, kLeastDwell);
  return course;
}

std::vector<std::vector<std::size_t>> groupsByJump(const std::vector<double>& feature, double factor) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < feature.size(); ++c) {
    if (feature[c] > 0) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return feature[a] < feature[b]; });
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool jumps = k > 0 && feature[order[k]] > factor * feature[order[k - 1]];
    if (k == 0 || jumps) groups.emplace_back();
    groups.back().push_back(order[k]);
  }
  for (auto& group : groups) std::sort(group.begin(), group.end());
  return groups;
}

Protocols protocolsOf(const std::vector<Recording>& recordings, const std::vector<Sections>& sections) {
  Protocols protocols;
  CourseScale scale;
  double lowest = std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> rates;
  for (const Recording& recording : recordings) {
    rates.push_back(pressureRates(recording));
    for (const double rate : rates.back()) scale.fastest = std::max(scale.fastest, std::abs(rate));
    for (const double pressure : recording.pressure) {
      scale.highest = std::max(scale.highest, pressure);
      lowest = std::min(lowest, pressure);
    }
    protocols.of_scan.emplace_back(recording.scans(), Protocols::kOther);
    protocols.part_of_scan.emplace_back(recording.scans(), std::uint8_t{0});
  }
  protocols.highest = scale.highest;
  protocols.lowest = std::min(lowest, scale.highest);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    protocols.longest_hold =
        std::max(protocols.longest_hold, longestHold(recordings[r], rates[r], scale.fastest));
  }
  const std::vector<Cycle> cycles = cyclesOf(recordings, sections);
  std::vector<CycleCourse> courses;
  std::size_t scans = 0;
  for (const Cycle& cycle : cycles) {
    const Recording& recording = recordings[cycle.recording];
    const std::size_t first = cycle.scans.front(), length = cycle.scans.back() + 1 - first;
    courses.push_back(courseOf(&recording.time[first], &recording.pressure[first],
                               &rates[cycle.recording][first], length, scale));
    scans += cycle.scans.size();
  }
  const auto keys = keysOf(courses);
  std::map<std::array<std::size_t, 3>, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < cycles.size(); ++c) groups[keys[c]].push_back(c);
  for (const auto& [key, members] : groups) {
    std::size_t own = 0;
    for (const std::size_t c : members) own += cycles[c].scans.size();
    if (static_cast<double>(own) < kLeastShare * static_cast<double>(scans)) continue;
    const auto number = static_cast<std::uint32_t>(protocols.names.size());
    protocols.names.push_back(nameOf(members, courses, keys));
    const std::size_t parts = std::min(members.size(), Protocols::kMostCycles);
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Cycle& cycle = cycles[members[m]];
      for (const std::size_t i : cycle.scans) {
        const bool unloads = sections[cycle.recording].direction[i] == statistics::LoadDirection::kUnloading;
        protocols.of_scan[cycle.recording][i] = number;
        protocols.part_of_scan[cycle.recording][i] =
            static_cast<std::uint8_t>(2 * (m * parts / members.size()) + (unloads ? 1 : 0));
      }
    }
  }
  return protocols;
}

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
