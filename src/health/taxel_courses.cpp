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
constexpr double kLeastRange = 0.5;  // of the median range: least unit

// Scans of a stay by ascending median reading, in groups of about equal size. A part of the groups divides
// the scans evenly, the other part the readings: a sheet may rest for long.
struct Groups {
  std::vector<std::uint32_t> scans;
  std::vector<std::size_t> ends;  // of each group in `scans`
};

Groups groupsOf(const std::vector<float>& median) {
  const std::size_t scans = median.size();
  Groups groups;
  groups.scans.resize(scans);
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
  return groups;
}

// Mean of the middle half of the values: as robust as the median here, and not bound to whole counts.
double middleMean(std::vector<double>& values) {
  const std::size_t from = values.size() / 4, to = values.size() - from;
  std::nth_element(values.begin(), values.begin() + from, values.end());
  std::nth_element(values.begin() + from, values.begin() + (to - 1), values.end());
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

// Range of a straight line through a curve, times the share of the curve's variance.
double responseOf(const Eigen::ArrayXd& at, const Eigen::ArrayXd& value) {
  const Eigen::ArrayXd x = at - at.mean(), y = value - value.mean();
  const double xx = x.square().sum(), xy = (x * y).sum(), yy = y.square().sum();
  return xx > 0 && yy > 0 ? std::max(0.0, xy / xx) * (at[at.size() - 1] - at[0]) * xy * xy / (xx * yy) : 0;
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
  std::vector<double> values, responses;
  const auto eachGroup = [&](auto valueOf, auto use) {
    for (std::size_t k = 0, i = 0; k < groups.ends.size(); ++k) {
      for (values.clear(); i < groups.ends[k]; ++i) values.push_back(double(valueOf(groups.scans[i])));
      use(static_cast<Eigen::Index>(k));
    }
  };
  eachGroup([&](std::size_t i) { return courses.place[i]; },
            [&](Eigen::Index k) {
              curves.at[k] = std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
            });
  std::vector<float> readings(courses.scans());  // the groups jump in time; in a file that would be slow
  for (Eigen::Index t = 0; t < taxels; ++t) {
    if (!sheet_.used[t]) continue;
    TaxelCourse course(courses, t);
    for (std::size_t i = 0; i < readings.size(); ++i) readings[i] = static_cast<float>(course.reading(i));
    eachGroup([&](std::size_t i) { return readings[i]; },
              [&](Eigen::Index k) { curves.value(t, k) = mostUsual(values); });
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
