#include "discrepancy/samples/taxel_courses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dataset/count_readers.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

// Points of a taxel's curve, and the fewest scans at each.
constexpr std::size_t kPoints = 24, kScansAtPoint = 12;
// Response, relative to that of the same taxel elsewhere, below which a curve is that of a fault.
constexpr double kResponds = 0.3;
constexpr double kSoundScans = 0.05;  // least share of the loaded scans, to tell a fault from a silent bend
constexpr double kLeastRange = 0.5;   // of the median range: least unit

// Reading of one taxel as a function of the median reading, by points.
struct Curve {
  std::vector<double> value;  // at the points of its visit
  double range() const {
    const auto [low, high] = std::minmax_element(value.begin(), value.end());
    return value.empty() ? 0 : *high - *low;
  }
  double response = 0;  // range of a straight line through it, times the share of its variance
};

double responseOf(const std::vector<double>& at, const std::vector<double>& value) {
  const auto n = static_cast<double>(at.size());
  const double x = std::accumulate(at.begin(), at.end(), 0.0) / n;
  const double y = std::accumulate(value.begin(), value.end(), 0.0) / n;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    xx += (at[i] - x) * (at[i] - x);
    xy += (at[i] - x) * (value[i] - y);
    yy += (value[i] - y) * (value[i] - y);
  }
  if (!(xx > 0) || !(yy > 0)) return 0;
  return std::max(0.0, xy / xx) * (at.back() - at.front()) * xy * xy / (xx * yy);
}

// Scans of a visit by ascending median reading, in groups of about equal size.
struct Groups {
  std::vector<std::vector<std::size_t>> scans;
  std::vector<double> at;  // mean of the median reading in each group [share of full scale]
};

Groups groupsOf(const std::vector<double>& common) {
  std::vector<std::size_t> order(common.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return common[a] < common[b]; });
  // A part of the groups divides the scans evenly, the other part the readings: a visit may rest for long.
  const std::size_t number = std::clamp<std::size_t>(common.size() / kScansAtPoint, 2, kPoints);
  const double low = common[order.front()], high = common[order.back()];
  Groups groups;
  std::vector<std::size_t> now;
  double from = low;
  for (std::size_t k = 0; k < order.size(); ++k) {
    now.push_back(order[k]);
    const bool wide = common[order[k]] - from >= (high - low) / static_cast<double>(number);
    const bool full = now.size() >= 4 * common.size() / number;
    if (now.size() < kScansAtPoint || !(wide || full) || order.size() - k <= kScansAtPoint) continue;
    groups.scans.push_back(std::move(now));
    now.clear();
    from = common[order[k]];
  }
  if (!now.empty()) groups.scans.push_back(std::move(now));
  for (const auto& scans : groups.scans) {
    double sum = 0;
    for (const std::size_t i : scans) sum += common[i];
    groups.at.push_back(sum / static_cast<double>(scans.size()));
  }
  return groups;
}

// Mean of the middle half of the values.
double middleMean(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const std::size_t from = values.size() / 4, to = values.size() - from;
  return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(from),
                         values.begin() + static_cast<std::ptrdiff_t>(to), 0.0) /
         static_cast<double>(to - from);
}

// Mean of the values around the shortest interval that holds half of them: what less than half of the values
// do, anywhere, does not count. Source: D. Andrews et al., Robust estimates of location, Princeton 1972
// (shorth), followed by one step of rejection.
double mostUsual(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  double width = std::numeric_limits<double>::infinity();
  std::size_t first = 0, last = 0;  // where the shortest intervals begin
  for (std::size_t i = 0; i + half < values.size(); ++i) {
    const double now = values[i + half] - values[i];
    if (now < width) first = i;
    if (now <= width) last = i;
    width = std::min(now, width);
  }
  const std::size_t from = (first + last) / 2;
  const double centre = (values[from] + values[from + half]) / 2;
  // Half of the values of a normal distribution lie within 0.674 standard deviations.
  const double reach = 3 * std::max(width, values[last + half] - values[first]) / (2 * 0.674);
  double sum = 0, number = 0;
  for (const double value : values) {
    if (std::abs(value - centre) > reach) continue;
    sum += value;
    ++number;
  }
  return sum / number;
}

// By the points next to `at`; linear beyond the ends.
VisitCourses::Between placeOf(const std::vector<double>& points, double at) {
  if (points.size() < 2) return {};
  const auto after = std::upper_bound(points.begin(), points.end(), at) - points.begin();
  const auto k = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(after, 1, static_cast<std::ptrdiff_t>(points.size()) - 1));
  const double width = points[k] - points[k - 1];
  return {static_cast<std::uint32_t>(k), width > 0 ? (at - points[k - 1]) / width : NAN};
}

// Whether a taxel reads about what is expected in some of the loaded scans.
bool soundSomewhere(const VisitCourses& courses, std::size_t taxel, const std::vector<double>& expected) {
  const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
  double loaded = 0, sound = 0;
  TaxelCourse course(courses, taxel);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] < (*low + *high) / 2) continue;
    ++loaded;
    sound +=
        std::abs(static_cast<double>(course.recorded(i)) - expected[i]) < kResponds * (expected[i] - *low);
  }
  return sound > kSoundScans * loaded;
}

// Counts are stored scan after scan. What goes through the scans taxel by taxel reads so many taxels at a
// time.
constexpr std::size_t kTaxelsTogether = 4;

class Builder {
 public:
  explicit Builder(const Measured& measured) : measured_(measured) {}
  std::vector<VisitCourses> run();

 private:
  void readVisit(std::size_t visit);
  void readTaxels(const VisitCourses& courses, std::size_t first, std::vector<float>* readings) const;
  void fitCurves(std::size_t visit);
  std::vector<double> medianRange() const;
  const Curve* standIn(std::size_t visit, std::size_t taxel, std::size_t& from) const;
  void expect(std::size_t visit, std::size_t taxel);
  bool responds(std::size_t visit, std::size_t taxel) const {
    return curves_[visit][taxel].response >= kResponds * usual_[taxel] * median_range_[visit];
  }

  const Measured& measured_;
  std::vector<VisitCourses> visits_;
  std::vector<std::vector<double>> at_;     // points of the curves, [visits]
  std::vector<std::vector<Curve>> curves_;  // [visits][taxels]
  std::vector<double> median_range_;        // of the taxels' ranges, [visits]
  std::vector<double> usual_;               // range of each taxel / median range, largest over the visits
};

void Builder::readVisit(std::size_t visit) {
  const Visit& at = measured_.visits[visit];
  const dataset::Recording& recording = (*measured_.recordings)[at.recording];
  VisitCourses courses;
  courses.visit = visit;
  courses.recording = &recording;
  courses.first_scan = at.first_scan;
  courses.offset = measured_.time[at.first] - recording.time[at.first_scan];
  courses.full_scale = measured_.full_scale;
  courses.common.reserve(at.last_scan - at.first_scan);
  std::vector<double> values;
  dataset::ScanCounts scans(recording);
  for (std::size_t s = at.first_scan; s < at.last_scan; ++s) {
    const std::uint16_t* counts = scans[s];
    values.clear();
    for (std::size_t t = 0; t < measured_.taxels(); ++t) {
      if (measured_.used[t]) values.push_back(counts[t] / measured_.full_scale);
    }
    // The mean of the middle half is as robust as the median here, and not bound to whole counts.
    courses.common.push_back(middleMean(values));
  }
  visits_.push_back(std::move(courses));
}

// Readings of the taxels from `first` on, as many as there are up to kTaxelsTogether.
void Builder::readTaxels(const VisitCourses& courses, std::size_t first, std::vector<float>* readings) const {
  const std::size_t number = std::min(kTaxelsTogether, measured_.taxels() - first);
  std::vector<TaxelCourse> taxels;
  for (std::size_t k = 0; k < number; ++k) readings[k].resize(courses.scans());
  for (std::size_t k = 0; k < number; ++k) taxels.emplace_back(courses, first + k);
  for (std::size_t i = 0; i < courses.scans(); ++i) {
    for (std::size_t k = 0; k < number; ++k) readings[k][i] = taxels[k].recorded(i);
  }
}

void Builder::fitCurves(std::size_t visit) {
  VisitCourses& courses = visits_[visit];
  const Groups groups = groupsOf(courses.common);
  at_.push_back(groups.at);
  courses.between.reserve(courses.scans());
  for (const double common : courses.common) courses.between.push_back(placeOf(groups.at, common));
  curves_.emplace_back(measured_.taxels());
  std::vector<double> values, ranges;
  std::vector<float> readings[kTaxelsTogether];  // the groups jump in time; in the counts that would be slow
  for (std::size_t t = 0; t < measured_.taxels(); ++t) {
    if (t % kTaxelsTogether == 0) readTaxels(courses, t, readings);
    if (!measured_.used[t]) continue;
    Curve& curve = curves_.back()[t];
    const std::vector<float>& reading = readings[t % kTaxelsTogether];
    for (const auto& scans : groups.scans) {
      values.clear();
      for (const std::size_t i : scans) values.push_back(static_cast<double>(reading[i]));
      curve.value.push_back(mostUsual(values));
    }
    curve.response = responseOf(groups.at, curve.value);
    ranges.push_back(curve.response);
  }
  median_range_.push_back(statistics::upperMedian(ranges, 0));
}

// Curve of the same taxel in another visit, best on the same surface; nullptr = it responds nowhere.
const Curve* Builder::standIn(std::size_t visit, std::size_t taxel, std::size_t& from) const {
  const Curve* found = nullptr;
  for (const bool same : {true, false}) {
    for (std::size_t v = 0; v < visits_.size() && !found; ++v) {
      const bool alike = measured_.visits[v].curvature_class == measured_.visits[visit].curvature_class;
      if (v == visit || alike != same || !responds(v, taxel)) continue;
      found = &curves_[v][taxel];
      from = v;
    }
  }
  return found;
}

void Builder::expect(std::size_t visit, std::size_t taxel) {
  VisitCourses& courses = visits_[visit];
  const Curve* curve = &curves_[visit][taxel];
  std::size_t from = visit;
  courses.borrowed[taxel] = !responds(visit, taxel);
  if (courses.borrowed[taxel]) curve = standIn(visit, taxel, from);
  const double least = kLeastRange * median_range_[visit];
  std::vector<double> expected;
  const auto follow = [&] {
    courses.curve[taxel] = curve ? ReadingCurve{at_[from], curve->value, from != visit} : ReadingCurve{};
    expected.clear();
    for (std::size_t i = 0; i < courses.scans(); ++i) expected.push_back(courses.expectedShare(taxel, i));
  };
  follow();
  if (from != visit && curve &&
      measured_.visits[from].curvature_class != measured_.visits[visit].curvature_class &&
      !soundSomewhere(courses, taxel, expected)) {
    // Whether it fails or this bend silences it cannot be told.
    courses.borrowed[taxel] = false;
    curve = &curves_[visit][taxel];
    from = visit;
    follow();
  }
  courses.lowest[taxel] = expected.empty() ? 0 : *std::min_element(expected.begin(), expected.end());
  if (curve) courses.lowest[taxel] = *std::min_element(curve->value.begin(), curve->value.end());
  courses.unit[taxel] = std::max({curve ? curve->range() : 0, least, 1e-6});
}

std::vector<VisitCourses> Builder::run() {
  for (std::size_t v = 0; v < measured_.visits.size(); ++v) {
    readVisit(v);
    fitCurves(v);
  }
  usual_.assign(measured_.taxels(), 0);
  for (std::size_t t = 0; t < measured_.taxels(); ++t) {
    for (std::size_t v = 0; v < visits_.size(); ++v) {
      if (median_range_[v] > 0) usual_[t] = std::max(usual_[t], curves_[v][t].response / median_range_[v]);
    }
    // A taxel that responds nowhere: that of the others is usual.
    if (usual_[t] < kResponds) usual_[t] = 1;
  }
  for (std::size_t v = 0; v < visits_.size(); ++v) {
    VisitCourses& courses = visits_[v];
    courses.curve.resize(measured_.taxels());
    courses.unit.assign(measured_.taxels(), 1);
    courses.lowest.assign(measured_.taxels(), 0);
    courses.borrowed.assign(measured_.taxels(), false);
    for (std::size_t t = 0; t < measured_.taxels(); ++t) {
      if (measured_.used[t]) expect(v, t);
    }
  }
  return std::move(visits_);
}

}  // namespace

double VisitCourses::elsewhere(const ReadingCurve& curve, double common) {
  if (curve.at.empty()) return common;
  const Between at = placeOf(curve.at, common);
  if (at.point == 0) return curve.value.front();
  return interpolated(curve, at);
}

void VisitCourses::deviations(std::size_t taxel, std::size_t first, std::size_t last, double* result) const {
  const ReadingCurve& own = curve[taxel];
  const double low = lowest[taxel], one = unit[taxel];
  dataset::TaxelCounts counts(*recording, taxel);
  for (std::size_t i = first; i < last; ++i, ++result) {
    const auto share = static_cast<double>(static_cast<float>(counts[first_scan + i] / full_scale));
    const Between& at = between[i];
    const double usual = own.borrowed || at.point == 0 ? elsewhere(own, common[i]) : interpolated(own, at);
    *result = static_cast<double>(static_cast<float>((share - low) / one)) -
              static_cast<double>(static_cast<float>((usual - low) / one));
  }
}

std::vector<VisitCourses> taxelCourses(const Measured& measured) {
  return Builder(measured).run();
}

}  // namespace fsr::discrepancy
