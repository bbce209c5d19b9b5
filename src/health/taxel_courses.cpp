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
// Scans of a group with no more scans between them belong to one pass: noise leads out of a group and back.
constexpr std::uint32_t kScansBetweenPasses = 12;
constexpr double kLeastRange = 0.5;  // of the median range: least unit

// Scans of a stay by ascending median reading, in groups of about equal size. A part of the groups divides
// the scans evenly, the other part the readings: a sheet may rest for long. All passes through a group have
// the same weight: a fault that lasts through one slow cycle does not outweigh the fast ones beside it.
struct Groups {
  std::vector<std::uint32_t> scans;
  std::vector<float> weight;      // of each of `scans`; their sum is 1 in each pass
  std::vector<std::size_t> ends;  // of each group in `scans`
};

// Puts the scans from .. to - 1 in the order of time, and weighs them.
void weighPasses(Groups& groups, std::size_t from, std::size_t to) {
  std::vector<std::uint32_t>& scans = groups.scans;
  std::sort(scans.begin() + from, scans.begin() + to);
  for (std::size_t first = from, k = from + 1; k <= to; ++k) {
    if (k < to && scans[k] - scans[k - 1] <= kScansBetweenPasses) continue;
    std::fill(groups.weight.begin() + first, groups.weight.begin() + k, 1 / float(k - first));
    first = k;
  }
}

Groups groupsOf(const std::vector<float>& median) {
  const std::size_t scans = median.size();
  Groups groups;
  groups.scans.resize(scans);
  groups.weight.resize(scans);
  std::vector<std::uint32_t>& order = groups.scans;
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return median[a] < median[b]; });
  const std::size_t number = std::clamp<std::size_t>(scans / kScansAtPoint, 2, kPoints);
  const float wide = (median[order.back()] - median[order.front()]) / float(number);
  for (std::size_t from = 0, k = 0; k < scans; ++k) {
    const std::size_t size = k + 1 - from;
    const bool full = median[order[k]] - median[order[from]] >= wide || size >= 4 * scans / number;
    if (k + 1 < scans && (size < kScansAtPoint || !full || scans - k <= kScansAtPoint)) continue;
    groups.ends.push_back(k + 1);
    from = k + 1;
  }
  for (std::size_t k = 0; k < groups.ends.size(); ++k)
    weighPasses(groups, k == 0 ? 0 : groups.ends[k - 1], groups.ends[k]);
  return groups;
}

// Mean of the middle half of the values: as robust as the median here, and not bound to whole counts.
double middleMean(std::vector<double>& values) {
  const std::size_t from = values.size() / 4, to = values.size() - from;
  std::nth_element(values.begin(), values.begin() + from, values.end());
  std::nth_element(values.begin() + from, values.begin() + (to - 1), values.end());
  return std::accumulate(values.begin() + from, values.begin() + to, 0.0) / double(to - from);
}

struct Weighed {
  double value = 0, weight = 0;
};

// Mean of the values around the shortest interval that holds half of their weight: what less than half of it
// does, anywhere, does not count. Source: D. Andrews et al., Robust estimates of location, Princeton 1972
// (shorth), followed by one step of rejection.
double mostUsual(std::vector<Weighed>& values) {
  std::sort(values.begin(), values.end(), [](auto& a, auto& b) { return a.value < b.value; });
  double half = 0, inside = 0;
  for (const Weighed& one : values) half += one.weight / 2;
  double width = std::numeric_limits<double>::infinity();
  double low = 0, high = 0;  // centre of the first and of the last of the shortest intervals
  for (std::size_t i = 0, end = 0; i < values.size(); inside -= values[i++].weight) {
    while (end < values.size() && inside <= half) inside += values[end++].weight;
    if (inside <= half) break;
    const double now = values[end - 1].value - values[i].value;
    const double centre = (values[end - 1].value + values[i].value) / 2;
    if (now < width) low = centre;
    if (now <= width) high = centre;
    width = std::min(now, width);
  }
  // Half of the values of a normal distribution lie within 0.674 standard deviations.
  const double centre = (low + high) / 2, reach = 3 * (width + high - low) / (2 * 0.674);
  double sum = 0, weights = 0;
  for (const Weighed& one : values) {
    if (std::abs(one.value - centre) > reach) continue;
    sum += one.weight * one.value;
    weights += one.weight;
  }
  return sum / weights;
}

// Readings of the taxels of a stay at some median readings.
struct Curves {
  Eigen::ArrayXd at;        // [points] [share of full scale]
  Eigen::ArrayXXd value;    // [taxels x points] [share of full scale]
  Eigen::ArrayXd response;  // [taxels] [share of full scale]
  double median_response = 0;
  // Place of a median reading among the points.
  double place(double median) const {
    const auto after = std::upper_bound(at.begin(), at.end(), median) - at.begin();
    const auto k = std::clamp<Eigen::Index>(after, 1, at.size() - 1);
    const double width = at[k] - at[k - 1];
    return double(k) - (width > 0 ? (at[k] - median) / width : 0);
  }
};

// Range of a straight line through a curve, times the share of the curve's variance; but not more than what
// half of the points show. Beside a fault that lasts through most readings, a few that it has not met would
// make a line.
double responseOf(const Eigen::ArrayXd& at, const Eigen::ArrayXd& value) {
  const Eigen::ArrayXd x = at - at.mean(), y = value - value.mean();
  const double xx = x.square().sum(), xy = (x * y).sum(), yy = y.square().sum();
  if (!(xx > 0 && yy > 0)) return 0;
  const double range = at[at.size() - 1] - at[0];
  std::vector<double> rises;
  for (Eigen::Index k = 1; k < at.size(); ++k) {
    if (at[k] > at[0]) rises.push_back((value[k] - value[0]) / (at[k] - at[0]));
  }
  const double line = xy / xx * xy * xy / (xx * yy);
  return range * std::max(0.0, std::min(line, statistics::upperMedian(rises, 0)));
}

class CourseBuilder {
 public:
  explicit CourseBuilder(const Sheet& sheet) : sheet_(sheet) {}
  std::vector<StayCourses> run();

 private:
  void read(const Stay& stay);
  void fit(StayCourses& courses);
  bool responds(std::size_t stay, std::size_t taxel) const {
    return curves_[stay].response[taxel] >= kResponds * usual_[taxel] * curves_[stay].median_response;
  }
  std::size_t standIn(std::size_t stay, std::size_t taxel) const;
  void expect(std::size_t stay, std::size_t taxel);

  const Sheet& sheet_;
  std::vector<StayCourses> courses_;
  std::vector<Curves> curves_;  // [stays]
  Eigen::ArrayXd usual_;        // response of each taxel / median response, largest over the stays
};

// `place` holds the median readings until fit().
void CourseBuilder::read(const Stay& stay) {
  StayCourses courses;
  courses.stay = &stay;
  courses.full_scale = sheet_.full_scale;
  courses.place.reserve(stay.scans());
  dataset::ScanCounts scans(*stay.recording);
  std::vector<double> values;
  for (std::size_t i = stay.first; i < stay.last; ++i) {
    const std::uint16_t* counts = scans[i];
    values.clear();
    for (std::size_t t = 0; t < sheet_.used.size(); ++t)
      if (sheet_.used[t]) values.push_back(counts[t] / sheet_.full_scale);
    courses.place.push_back(static_cast<float>(middleMean(values)));
  }
  courses_.push_back(std::move(courses));
}

void CourseBuilder::fit(StayCourses& courses) {
  const auto taxels = static_cast<Eigen::Index>(sheet_.used.size());
  const Groups groups = groupsOf(courses.place);
  const auto points = static_cast<Eigen::Index>(groups.ends.size());
  Curves curves{Eigen::ArrayXd::Zero(points), Eigen::ArrayXXd::Zero(taxels, points),
                Eigen::ArrayXd::Zero(taxels)};
  // Calls use(k, values) for the values of the scans in each group.
  std::vector<Weighed> values;
  std::vector<double> responses;
  const auto eachGroup = [&](const std::vector<float>& of_scans, auto use) {
    for (std::size_t k = 0, i = 0; k < groups.ends.size(); ++k) {
      for (values.clear(); i < groups.ends[k]; ++i)
        values.push_back({double(of_scans[groups.scans[i]]), double(groups.weight[i])});
      use(static_cast<Eigen::Index>(k));
    }
  };
  eachGroup(courses.place, [&](Eigen::Index k) {
    double weights = 0;
    for (const Weighed& one : values) {
      curves.at[k] += one.weight * one.value;
      weights += one.weight;
    }
    curves.at[k] /= weights;
  });
  std::vector<float> readings(courses.scans());  // the groups jump in time; in a file that would be slow
  for (Eigen::Index t = 0; t < taxels; ++t) {
    if (!sheet_.used[t]) continue;
    TaxelCourse course(courses, t);
    for (std::size_t i = 0; i < readings.size(); ++i) readings[i] = static_cast<float>(course.reading(i));
    eachGroup(readings, [&](Eigen::Index k) { curves.value(t, k) = mostUsual(values); });
    responses.push_back(curves.response[t] = responseOf(curves.at, curves.value.row(t)));
  }
  if (points == 1) {  // a constant
    curves.at = curves.at.replicate(2, 1).eval();
    curves.value = curves.value.replicate(1, 2).eval();
  }
  curves.median_response = statistics::upperMedian(responses, 0);
  for (float& place : courses.place) place = static_cast<float>(curves.place(double(place)));
  courses.curve = curves.value;
  courses.unit.setOnes(taxels);
  courses.lowest.setZero(taxels);
  courses.foreign.resize(sheet_.used.size());
  curves_.push_back(std::move(curves));
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

void CourseBuilder::expect(std::size_t stay, std::size_t taxel) {
  StayCourses& courses = courses_[stay];
  const Curves& own = curves_[stay];
  const std::size_t from = responds(stay, taxel) ? stay : standIn(stay, taxel);
  auto curve = courses.curve.row(taxel);
  if (from == courses_.size())
    curve = own.at;
  else if (from != stay) {
    const Curves& other = curves_[from];
    for (Eigen::Index k = 0; k < own.at.size(); ++k) {
      const double place = other.place(own.at[k]);
      const auto before = std::clamp<Eigen::Index>(Eigen::Index(place), 0, other.at.size() - 2);
      curve[k] = other.value(taxel, before) +
                 (place - double(before)) * (other.value(taxel, before + 1) - other.value(taxel, before));
    }
    courses.foreign[taxel] = sheet_.stays[from].surface != sheet_.stays[stay].surface;
  }
  courses.lowest[taxel] = curve.minCoeff();
  const double range = from == courses_.size() ? 0 : curve.maxCoeff() - curve.minCoeff();
  courses.unit[taxel] = std::max({range, kLeastRange * own.median_response, 1e-6});
}

std::vector<StayCourses> CourseBuilder::run() {
  usual_.setZero(static_cast<Eigen::Index>(sheet_.used.size()));
  for (const Stay& stay : sheet_.stays) {
    read(stay);
    fit(courses_.back());
    const Curves& curves = curves_.back();
    if (curves.median_response > 0) usual_ = usual_.max(curves.response / curves.median_response);
  }
  // A taxel that responds nowhere: that of the others is usual.
  usual_ = (usual_ < kResponds).select(1, usual_);
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    for (std::size_t t = 0; t < sheet_.used.size(); ++t) {
      if (sheet_.used[t]) expect(v, t);
    }
  }
  return std::move(courses_);
}

}  // namespace

std::vector<StayCourses> taxelCourses(const Sheet& sheet) {
  return CourseBuilder(sheet).run();
}

}  // namespace fsr::health
