#include "dataset/unsound/unsound_spans.h"

#include <algorithm>
#include <limits>
#include <map>

#include "settings/number_text.h"

namespace fsr::dataset {

namespace {

constexpr double kRareReadings = 0.02;  // share beyond each end of the usual range: may be faults
constexpr double kSheetAtRest = 0.1;    // share of the usual range up to which the sheet is not loaded
constexpr std::size_t kListed = 5;      // spans that are named one by one

// The reading up to which the sheet is at rest on each surface: a bent sheet has another one than a flat one.
std::map<std::uint32_t, double> restReadings(const ScanCourse& course) {
  std::map<std::uint32_t, std::vector<double>> readings;
  for (std::size_t i = 0; i < course.scans(); ++i) readings[course.condition[i]].push_back(course.reading[i]);
  std::map<std::uint32_t, double> rest;
  for (auto& [condition, values] : readings) {
    std::sort(values.begin(), values.end());
    const auto rare = static_cast<std::size_t>(kRareReadings * static_cast<double>(values.size()));
    const double low = values[rare], high = values[values.size() - 1 - rare];
    rest[condition] = low + kSheetAtRest * (high - low);
  }
  return rest;
}

std::size_t firstAfter(const ScanCourse& course, std::int64_t stamp_ns) {
  const auto found = std::upper_bound(course.stamp_ns.begin(), course.stamp_ns.end(), stamp_ns);
  return static_cast<std::size_t>(found - course.stamp_ns.begin());
}

}  // namespace

std::vector<UnsoundSpan> rejectedSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends) {
  std::vector<UnsoundSpan> spans;
  const auto misleads = [](const AttemptEnd& end) { return readingsMislead(end.reason); };
  if (std::none_of(ends.begin(), ends.end(), misleads)) return spans;
  const std::map<std::uint32_t, double> rest = restReadings(course);
  const auto rests = [&](std::size_t i) {
    return course.pressure[i] <= kRestLevel && course.reading[i] <= rest.at(course.condition[i]);
  };
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (!misleads(ends[e])) continue;
    const std::size_t least = e == 0 ? 0 : firstAfter(course, ends[e - 1].stamp_ns);
    const std::size_t most = e + 1 == ends.size() ? course.scans() : firstAfter(course, ends[e + 1].stamp_ns);
    UnsoundSpan span;
    span.first = span.end = firstAfter(course, ends[e].stamp_ns);
    // Some attempts are judged when the chamber is at rest again.
    while (span.first > least && rests(span.first - 1)) --span.first;
    while (span.first > least && !rests(span.first - 1)) --span.first;
    while (span.end < most && !rests(span.end)) ++span.end;
    span.why = "attempt rejected: " + name(ends[e].reason);
    if (span.first < span.end) spans.push_back(span);
  }
  return spans;
}

std::string unsoundText(const ScanCourse& course, const std::vector<UnsoundSpan>& spans) {
  const auto seconds = [&](std::size_t i) {
    return settings::fixedText(1e-9 * static_cast<double>(course.stamp_ns[i] - course.stamp_ns[0]), 1);
  };
  std::vector<bool> unsound(course.scans(), false);
  std::string list;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    std::fill(unsound.begin() + static_cast<std::ptrdiff_t>(spans[s].first),
              unsound.begin() + static_cast<std::ptrdiff_t>(spans[s].end), true);
    if (s >= kListed) continue;
    list += (list.empty() ? "" : ", ") + seconds(spans[s].first) + " to " + seconds(spans[s].end - 1) +
            " s (" + spans[s].why + ")";
  }
  if (spans.empty()) return "";
  if (spans.size() > kListed) list += " and " + std::to_string(spans.size() - kListed) + " more";
  const auto scans = std::count(unsound.begin(), unsound.end(), true);
  return "left out " + std::to_string(scans) + (scans == 1 ? " scan that is" : " scans that are") +
         " not the sheet under the recorded pressure: " + list;
}

}  // namespace fsr::dataset
