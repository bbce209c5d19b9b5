#include "health/taxel_courses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dataset/count_readers.h"
#include "statistics/samples.h"

namespace fsr::health {

namespace {

// Points of a taxel's curve, and the fewest scans at each.
constexpr std::size_t kPoints = 24, kScansAtPoint = 12;
// Response, relative to that of the same taxel elsewhere, below which a curve is that of a fault.
constexpr double kResponds = 0.3;
constexpr double kSoundScans = 0.05;  // least share of the loaded scans, to tell a fault from a silent bend
constexpr double kLeastRange = 0.5;   // of the median range: least unit

// Scans of a stay by ascending median reading, in groups of about equal size. A part of the groups divides
// the scans evenly, the other part the readings: a sheet may rest for long.
std::vector<std::vector<std::size_t>> groupsOf(const std::vector<double>& median) {
  std::vector<std::size_t> order(median.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return median[a] < median[b]; });
  const std::size_t number = std::clamp<std::size_t>(median.size() / kScansAtPoint, 2, kPoints);
  const double wide = (median[order.back()] - median[order.front()]) / double(number);
  std::vector<std::vector<std::size_t>> groups(1);
  double from = median[order.front()];
  for (std::size_t k = 0; k < order.size(); ++k) {
    groups.back().push_back(order[k]);
    const bool full = median[order[k]] - from >= wide || groups.back().size() >= 4 * median.size() / number;
    if (groups.back().size() < kScansAtPoint || !full || order.size() - k <= kScansAtPoint) continue;
    groups.emplace_back();
    from = median[order[k]];
  }
  return groups;
}

// Mean of the middle half of the values: as robust as the median here, and not bound to whole counts.
double middleMean(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const std::size_t from = values.size() / 4, to = values.size() - from;
  return std::accumulate(values.begin() + from, values.begin() + to, 0.0) / double(to - from);
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

// Range of a straight line through a curve, times the share of the curve's variance.
double responseOf(const ReadingCurve& curve) {
  const auto n = curve.at.size();
  const Eigen::Map<const Eigen::ArrayXd> at(curve.at.data(), n), value(curve.value.data(), n);
  const Eigen::ArrayXd x = at - at.mean(), y = value - value.mean();
  const double xx = x.square().sum(), xy = (x * y).sum(), yy = y.square().sum();
  return xx > 0 && yy > 0 ? std::max(0.0, xy / xx) * (at[n - 1] - at[0]) * xy * xy / (xx * yy) : 0;
}

class CourseBuilder {
 public:
  explicit CourseBuilder(const Sheet& sheet) : sheet_(sheet), usual_(sheet.used.size(), 0) {}
  std::vector<StayCourses> run();

 private:
  void read(const Stay& stay);
  void fit(StayCourses& courses);
  bool responds(std::size_t stay, std::size_t taxel) const {
    return response_[stay][taxel] >= kResponds * usual_[taxel] * median_response_[stay];
  }
  std::size_t standIn(std::size_t stay, std::size_t taxel) const;
  bool soundSomewhere(const StayCourses& courses, std::size_t taxel, const ReadingCurve& curve) const;
  void expect(std::size_t stay, std::size_t taxel);

  const Sheet& sheet_;
  std::vector<StayCourses> courses_;
  std::vector<std::vector<ReadingCurve>> curves_;  // [stays][taxels]
  std::vector<std::vector<double>> response_;      // [stays][taxels] [share of full scale]
  std::vector<double> median_response_;            // [stays]
  std::vector<double> usual_;  // response of each taxel / median response, largest over the stays
};

// `deviation` holds the readings until expect().
void CourseBuilder::read(const Stay& stay) {
  StayCourses courses;
  const std::size_t taxels = sheet_.used.size();
  courses.deviation.resize(stay.scans(), taxels);
  dataset::ScanCounts scans(*stay.recording);
  std::vector<double> values;
  for (std::size_t i = 0; i < stay.scans(); ++i) {
    const std::uint16_t* counts = scans[stay.first + i];
    values.clear();
    for (std::size_t t = 0; t < taxels; ++t) {
      const double reading = counts[t] / sheet_.full_scale;
      courses.deviation(i, t) = static_cast<float>(reading);
      if (sheet_.used[t]) values.push_back(reading);
    }
    courses.median.push_back(middleMean(values));
  }
  courses.curve.resize(taxels);
  courses.unit.assign(taxels, 1);
  courses.lowest.assign(taxels, 0);
  courses_.push_back(std::move(courses));
}

void CourseBuilder::fit(StayCourses& courses) {
  const std::vector<std::vector<std::size_t>> groups = groupsOf(courses.median);
  std::vector<double> at, values, responses;
  for (const std::vector<std::size_t>& group : groups) {
    double sum = 0;
    for (const std::size_t i : group) sum += courses.median[i];
    at.push_back(sum / double(group.size()));
  }
  curves_.emplace_back(sheet_.used.size());
  response_.emplace_back(sheet_.used.size(), 0);
  for (std::size_t t = 0; t < sheet_.used.size(); ++t) {
    if (!sheet_.used[t]) continue;
    ReadingCurve& curve = curves_.back()[t];
    curve.at = at;
    for (const std::vector<std::size_t>& group : groups) {
      values.clear();
      for (const std::size_t i : group) values.push_back(courses.deviates(t, i));
      curve.value.push_back(mostUsual(values));
    }
    responses.push_back(response_.back()[t] = responseOf(curve));
  }
  median_response_.push_back(statistics::upperMedian(responses, 0));
}

// Stay whose curve is taken for the taxel, best on the same surface; the number of stays = it responds
// nowhere.
std::size_t CourseBuilder::standIn(std::size_t stay, std::size_t taxel) const {
  for (const bool same : {true, false}) {
    for (std::size_t v = 0; v < courses_.size(); ++v) {
      if (v != stay && (sheet_.stays[v].surface == sheet_.stays[stay].surface) == same && responds(v, taxel))
        return v;
    }
  }
  return courses_.size();
}

// Whether a taxel reads about what a curve says in some of the loaded scans.
bool CourseBuilder::soundSomewhere(const StayCourses& courses, std::size_t taxel,
                                   const ReadingCurve& curve) const {
  std::vector<double> expected;
  for (const double median : courses.median) expected.push_back(curve(median));
  const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
  double loaded = 0, sound = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] < (*low + *high) / 2) continue;
    ++loaded;
    sound += std::abs(courses.deviates(taxel, i) - expected[i]) < kResponds * (expected[i] - *low);
  }
  return sound > kSoundScans * loaded;
}

void CourseBuilder::expect(std::size_t stay, std::size_t taxel) {
  StayCourses& courses = courses_[stay];
  std::size_t from = responds(stay, taxel) ? stay : standIn(stay, taxel);
  // Whether it fails or another bend silences it cannot be told.
  if (from < courses_.size() && sheet_.stays[from].surface != sheet_.stays[stay].surface &&
      !soundSomewhere(courses, taxel, curves_[from][taxel]))
    from = stay;
  ReadingCurve& curve = courses.curve[taxel];
  if (from < courses_.size()) curve = curves_[from][taxel];
  const std::vector<double>& readings = curve.value.empty() ? courses.median : curve.value;
  courses.lowest[taxel] = *std::min_element(readings.begin(), readings.end());
  courses.unit[taxel] = std::max({curve.range(), kLeastRange * median_response_[stay], 1e-6});
  for (std::size_t i = 0; i < courses.scans(); ++i) {
    float& value = courses.deviation(i, taxel);
    value = static_cast<float>((double(value) - curve(courses.median[i])) / courses.unit[taxel]);
  }
}

std::vector<StayCourses> CourseBuilder::run() {
  for (const Stay& stay : sheet_.stays) {
    read(stay);
    fit(courses_.back());
  }
  for (std::size_t t = 0; t < usual_.size(); ++t) {
    for (std::size_t v = 0; v < courses_.size(); ++v) {
      if (median_response_[v] > 0) usual_[t] = std::max(usual_[t], response_[v][t] / median_response_[v]);
    }
    // A taxel that responds nowhere: that of the others is usual.
    if (usual_[t] < kResponds) usual_[t] = 1;
  }
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    for (std::size_t t = 0; t < usual_.size(); ++t) {
      if (sheet_.used[t]) expect(v, t);
    }
  }
  return std::move(courses_);
}

}  // namespace

double ReadingCurve::operator()(double median) const {
  if (at.empty()) return median;
  if (at.size() == 1) return value.front();
  const auto after = std::upper_bound(at.begin(), at.end(), median) - at.begin();
  const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after, 1, at.size() - 1));
  const double width = at[k] - at[k - 1];
  return width > 0 ? value[k - 1] + (median - at[k - 1]) / width * (value[k] - value[k - 1]) : value[k];
}

double ReadingCurve::range() const {
  if (value.empty()) return 0;
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  return *high - *low;
}

std::vector<StayCourses> taxelCourses(const Sheet& sheet) {
  return CourseBuilder(sheet).run();
}

}  // namespace fsr::health
