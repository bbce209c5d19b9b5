#include "discrepancy/samples/taxel_courses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "statistics/random_stream.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kSpans[] = {2, 8, 32};                 // scans on each side of a step
constexpr std::size_t kFewestLines = 3, kFewestOfALine = 3;  // fewer have no neighbours, or are no line
constexpr float kMostDeviation = 1;  // a deviation beyond the taxel's range says no more

constexpr std::size_t kLongestSpan = kSpans[std::size(kSpans) - 1];
constexpr std::size_t kScansOfBlock = 4096;  // steps are computed for so many scans at a time

std::size_t strideOf(std::size_t span) {
  return std::max<std::size_t>(1, span / 4);
}

// A place in time where a step is looked for.
struct Place {
  std::size_t span = 0;  // index into kSpans
  std::size_t visit = 0, scan = 0;

  bool operator<(const Place& other) const {
    return std::tie(span, visit, scan) < std::tie(other.span, other.visit, other.scan);
  }
};

// Steps of the taxels at places of one span and visit: mean deviation over the scans after a place less the
// mean over those before it.
struct Steps {
  std::vector<Place> places;
  Eigen::MatrixXf of;  // [places x taxels], in units of the usual largest step of that span
};

// The largest step of a line, and where it is.
struct LargestStep {
  float size = -1;
  Place place;
  std::vector<double> of;  // steps of the line's taxels there
};

class LineTest {
 public:
  LineTest(const Measured& measured, const std::vector<VisitCourses>& courses, bool rows,
           const std::vector<bool>& sound)
      : measured_(measured), courses_(courses), rows_(rows), sound_(sound) {
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (sound[t]) taxels_.push_back(t);
    }
    lines_ = rows ? measured.layout.size.rows : measured.layout.size.columns;
  }
  LineFault run(const DiscrepancyOptions& options);

 private:
  std::size_t lineOf(std::size_t taxel) const {
    return rows_ ? measured_.layout.row({taxel}) : measured_.layout.column({taxel});
  }
  bool prepare();
  template <typename Use>
  void eachBlock(Use use) const;
  void findUsual();
  void divideByUsual(Steps& steps) const;
  Eigen::MatrixXf contrast(const Steps& steps, const std::vector<std::size_t>& order) const;
  std::vector<LargestStep> largestSteps() const;
  std::vector<float> largestOf(const std::vector<std::vector<std::size_t>>& orders) const;
  double byChance(float largest, const DiscrepancyOptions& options) const;
  bool together(const LargestStep& step, std::size_t line) const;
  std::vector<double> courseOf(std::size_t visit, std::size_t line) const;
  std::vector<bool> failing(std::size_t visit, std::size_t line, double least) const;

  const Measured& measured_;
  const std::vector<VisitCourses>& courses_;
  const bool rows_;
  const std::vector<bool>& sound_;
  std::vector<std::size_t> taxels_;  // the sound ones
  std::size_t lines_ = 0;
  std::vector<double> members_;  // sound taxels of each line
  std::vector<std::vector<std::size_t>> beside_;
  std::vector<double> noise_;  // of each line's contrast, per noise of a taxel
  std::vector<double> usual_;  // largest step of the taxels, [spans] [unit of the courses]
};

bool LineTest::prepare() {
  members_.assign(lines_, 0);
  for (const std::size_t t : taxels_) ++members_[lineOf(t)];
  std::vector<std::size_t> whole;
  for (std::size_t l = 0; l < lines_; ++l) {
    if (members_[l] >= kFewestOfALine) whole.push_back(l);
  }
  beside_.assign(lines_, {});
  noise_.assign(lines_, 0);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    double variance = 1 / members_[whole[k]];
    if (k > 0) beside_[whole[k]].push_back(whole[k - 1]);
    if (k + 1 < whole.size()) beside_[whole[k]].push_back(whole[k + 1]);
    for (const std::size_t b : beside_[whole[k]])
      variance += 1 / (members_[b] * std::pow(static_cast<double>(beside_[whole[k]].size()), 2));
    noise_[whole[k]] = std::sqrt(variance);
  }
  return whole.size() >= kFewestLines;
}

// Calls use(steps) for all places, block by block: the steps of all places would take three times the memory
// of the counts. Places of one span and visit ascend.
template <typename Use>
void LineTest::eachBlock(Use use) const {
  const auto taxels = static_cast<Eigen::Index>(taxels_.size());
  Steps steps;
  std::vector<double> deviations;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const std::size_t scans = courses_[v].scans();
    // Sums of the deviations before each scan, from first - kLongestSpan on.
    Eigen::MatrixXd sums(static_cast<Eigen::Index>(kScansOfBlock + 2 * kLongestSpan + 1), taxels);
    std::size_t known = 0;  // scans whose deviations are in the sums
    for (std::size_t first = 0; first <= scans; first += kScansOfBlock) {
      const std::size_t last = std::min(scans + 1, first + kScansOfBlock);  // of the places, excluded
      const std::size_t origin = first - std::min(first, kLongestSpan);     // scan of the first sum
      if (first == 0) {
        sums.row(0).setZero();
      } else {  // the end of the last block is the beginning of this one
        const std::size_t before = first - kScansOfBlock - std::min(first - kScansOfBlock, kLongestSpan);
        for (std::size_t i = origin; i <= known; ++i)
          sums.row(static_cast<Eigen::Index>(i - origin)) = sums.row(static_cast<Eigen::Index>(i - before));
      }
      const std::size_t end = std::min(scans, last + kLongestSpan);
      deviations.resize(end - known);
      for (std::size_t k = 0; k < taxels_.size(); ++k) {
        courses_[v].deviations(taxels_[k], known, end, deviations.data());
        double* sum = &sums(static_cast<Eigen::Index>(known - origin), static_cast<Eigen::Index>(k));
        for (const double deviation : deviations) {
          const double now = std::clamp(deviation, -double{kMostDeviation}, double{kMostDeviation});
          sum[1] = sum[0] + now;
          ++sum;
        }
      }
      known = end;
      for (std::size_t s = 0; s < std::size(kSpans); ++s) {
        const std::size_t span = kSpans[s], stride = strideOf(span);
        steps.places.clear();
        std::size_t at = span;
        if (first > span) at += (first - span + stride - 1) / stride * stride;
        for (; at < last && at + span <= scans; at += stride) steps.places.push_back({s, v, at});
        if (steps.places.empty()) continue;
        steps.of.resize(static_cast<Eigen::Index>(steps.places.size()), taxels);
        const auto reach = static_cast<std::ptrdiff_t>(span);
        for (Eigen::Index k = 0; k < taxels; ++k) {
          for (std::size_t p = 0; p < steps.places.size(); ++p) {
            const double* middle = &sums(static_cast<Eigen::Index>(steps.places[p].scan - origin), k);
            steps.of(static_cast<Eigen::Index>(p), k) = static_cast<float>(
                (middle[reach] - 2 * *middle + middle[-reach]) / static_cast<double>(span));
          }
        }
        use(steps);
      }
    }
  }
}

// The taxels' usual largest step of each span.
void LineTest::findUsual() {
  std::vector<std::vector<double>> largest(std::size(kSpans));
  eachBlock([&](const Steps& steps) {
    std::vector<double>& of_span = largest[steps.places.front().span];
    of_span.resize(taxels_.size(), 0);
    for (std::size_t k = 0; k < taxels_.size(); ++k) {
      const float most = steps.of.col(static_cast<Eigen::Index>(k)).cwiseAbs().maxCoeff();
      of_span[k] = std::max(of_span[k], static_cast<double>(most));
    }
  });
  for (const std::vector<double>& of_span : largest)
    usual_.push_back(std::max(1e-9, statistics::upperMedian(of_span, 0)));
}

void LineTest::divideByUsual(Steps& steps) const {
  steps.of /= static_cast<float>(usual_[steps.places.front().span]);
}

// Steps of each line less those of the lines beside it, in units of their noise. `order`: which taxel stands
// at the place of each one.
Eigen::MatrixXf LineTest::contrast(const Steps& steps, const std::vector<std::size_t>& order) const {
  const auto lines = static_cast<Eigen::Index>(lines_);
  Eigen::MatrixXf mean = Eigen::MatrixXf::Zero(steps.of.rows(), lines);
  for (std::size_t k = 0; k < taxels_.size(); ++k) {
    const std::size_t line = lineOf(taxels_[k]);
    mean.col(static_cast<Eigen::Index>(line)) +=
        steps.of.col(static_cast<Eigen::Index>(order[k])) / static_cast<float>(members_[line]);
  }
  Eigen::MatrixXf contrast = Eigen::MatrixXf::Zero(mean.rows(), lines);
  for (std::size_t l = 0; l < lines_; ++l) {
    if (!(noise_[l] > 0)) continue;
    const auto c = static_cast<Eigen::Index>(l);
    contrast.col(c) = mean.col(c);
    for (const std::size_t b : beside_[l])
      contrast.col(c) -= mean.col(static_cast<Eigen::Index>(b)) / static_cast<float>(beside_[l].size());
    contrast.col(c) /= static_cast<float>(noise_[l]);
  }
  return contrast;
}

// The largest step of each line; of equal ones the first.
std::vector<LargestStep> LineTest::largestSteps() const {
  std::vector<std::size_t> order(taxels_.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<LargestStep> largest(lines_);
  eachBlock([&](Steps& steps) {
    divideByUsual(steps);
    const Eigen::MatrixXf sizes = contrast(steps, order).cwiseAbs();
    for (std::size_t l = 0; l < lines_; ++l) {
      Eigen::Index at = 0;
      const float size = sizes.col(static_cast<Eigen::Index>(l)).maxCoeff(&at);
      const Place& place = steps.places[static_cast<std::size_t>(at)];
      LargestStep& best = largest[l];
      if (size < best.size || (size == best.size && !(place < best.place))) continue;
      best = {size, place, {}};
      for (std::size_t k = 0; k < taxels_.size(); ++k) {
        if (lineOf(taxels_[k]) == l)
          best.of.push_back(static_cast<double>(steps.of(at, static_cast<Eigen::Index>(k))));
      }
    }
  });
  return largest;
}

// The largest step of any line with the taxels in each of these orders.
std::vector<float> LineTest::largestOf(const std::vector<std::vector<std::size_t>>& orders) const {
  std::vector<float> largest(orders.size(), -1);
  eachBlock([&](Steps& steps) {
    divideByUsual(steps);
    for (std::size_t o = 0; o < orders.size(); ++o)
      largest[o] = std::max(largest[o], contrast(steps, orders[o]).cwiseAbs().maxCoeff());
  });
  return largest;
}

// Share of random orders of the taxels with a step as large as `largest`.
double LineTest::byChance(float largest, const DiscrepancyOptions& options) const {
  std::vector<std::size_t> order(taxels_.size());
  std::iota(order.begin(), order.end(), 0);
  std::size_t draws = 0, beyond = 0;
  const auto share = [&] { return static_cast<double>(1 + beyond) / static_cast<double>(draws + 1); };
  // Every batch of orders reads all scans once. Often few orders are enough.
  for (std::size_t batch = 2; draws < options.null_draws; batch *= 2) {
    std::vector<std::vector<std::size_t>> orders;
    for (std::size_t draw = draws; draw < std::min(options.null_draws, draws + batch); ++draw) {
      const statistics::RandomStream stream =
          statistics::randomStream(options.seed, rows_ ? "rows" : "columns", draw);
      for (std::size_t k = order.size(); k-- > 1;)
        std::swap(order[k], order[static_cast<std::size_t>(stream.uniform(k) * static_cast<double>(k + 1))]);
      orders.push_back(order);
    }
    for (const float drawn : largestOf(orders)) {
      ++draws;
      beyond += drawn >= largest;
      // No further draw can bring it below the level.
      if (2 * static_cast<double>(1 + beyond) > options.level * static_cast<double>(options.null_draws + 1))
        return share();
    }
  }
  return share();
}

// Whether the taxels of a line make the step together: their median step is at least half the mean.
bool LineTest::together(const LargestStep& step, std::size_t line) const {
  double mean = 0;
  for (const double own : step.of) mean += own / members_[line];
  std::vector<double> own = step.of;
  return statistics::upperMedian(own) / mean >= 0.5;
}

// Mean deviation of a line's taxels less that of the lines beside it.
std::vector<double> LineTest::courseOf(std::size_t visit, std::size_t line) const {
  std::vector<double> course(courses_[visit].scans(), 0);
  for (const std::size_t t : taxels_) {
    double weight = lineOf(t) == line ? 1 / members_[line] : 0;
    for (const std::size_t b : beside_[line]) {
      if (lineOf(t) == b) weight = -1 / (members_[b] * static_cast<double>(beside_[line].size()));
    }
    if (weight == 0) continue;
    TaxelCourse taxel(courses_[visit], t);
    for (std::size_t i = 0; i < course.size(); ++i) course[i] += weight * taxel.deviation(i);
  }
  return course;
}

// Scans of a visit in which the line fails. Its course is divided where it steps; a part fails where its mean
// is farther from the line's median than half a step that is significant. `least`: that step.
std::vector<bool> LineTest::failing(std::size_t visit, std::size_t line, double least) const {
  const std::vector<double> course = courseOf(visit, line);
  std::vector<bool> failing(course.size(), false);
  if (course.size() < 2 * kSpans[0]) return failing;
  std::vector<double> sum(course.size() + 1, 0);
  for (std::size_t i = 0; i < course.size(); ++i) sum[i + 1] = sum[i] + course[i];
  std::vector<std::size_t> cuts = {0};
  for (std::size_t s = 0; s < std::size(kSpans); ++s) {
    const std::size_t span = kSpans[s];
    const double limit = least * usual_[s];
    const auto size = [&](std::size_t at) {
      return std::abs(sum[at + span] - 2 * sum[at] + sum[at - span]) / static_cast<double>(span);
    };
    for (std::size_t at = span; at + span <= course.size(); ++at) {
      if (size(at) < limit) continue;
      bool largest = true;
      for (std::size_t o = at > 2 * span ? at - span : span;
           o <= at + span && o + span <= course.size() && largest; ++o)
        largest = size(o) < size(at) || (size(o) == size(at) && o >= at);
      const bool known = std::any_of(cuts.begin() + 1, cuts.end(), [&](std::size_t cut) {
        return std::max(cut, at) - std::min(cut, at) < span;
      });
      if (largest && !known) cuts.push_back(at);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.push_back(course.size());
  const double usual = statistics::upperMedian(course);
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const std::size_t length = cuts[c + 1] - cuts[c];
    std::size_t s = 0;
    while (s + 1 < std::size(kSpans) && kSpans[s + 1] <= length) ++s;
    const double mean = (sum[cuts[c + 1]] - sum[cuts[c]]) / static_cast<double>(length);
    if (std::abs(mean - usual) < least * usual_[s] / 2) continue;
    std::fill(failing.begin() + static_cast<std::ptrdiff_t>(cuts[c]),
              failing.begin() + static_cast<std::ptrdiff_t>(cuts[c + 1]), true);
  }
  return failing;
}

LineFault LineTest::run(const DiscrepancyOptions& options) {
  LineFault fault;
  if (!prepare()) return fault;
  findUsual();
  const std::vector<LargestStep> steps = largestSteps();
  const auto smaller = [](const LargestStep& a, const LargestStep& b) { return a.size < b.size; };
  const auto line = std::max_element(steps.begin(), steps.end(), smaller);
  const float largest = line->size;
  if (largest < 0) return fault;  // too few scans
  // Rows and columns are two tests.
  fault.p = std::min(1.0, 2 * byChance(largest, options));
  fault.line = static_cast<std::size_t>(line - steps.begin());
  if (fault.p > options.level || !together(*line, fault.line)) return fault;
  // Largest step of the lines that are not beside it. Permuted taxels would hold the fault.
  float others = 0;
  for (std::size_t l = 0; l < lines_; ++l) {
    const auto& beside = beside_[fault.line];
    if (l != fault.line && !std::count(beside.begin(), beside.end(), l))
      others = std::max(others, steps[l].size);
  }
  const double least =
      static_cast<double>(others > 0 ? std::min(others, largest / 2) : largest / 2) * noise_[fault.line];
  fault.found = true;
  for (const std::size_t t : taxels_) {
    if (lineOf(t) == fault.line) fault.taxels.push_back(t);
  }
  for (std::size_t v = 0; v < courses_.size(); ++v) fault.failing.push_back(failing(v, fault.line, least));
  return fault;
}

}  // namespace

LineFault findLineFault(const Measured& measured, const std::vector<VisitCourses>& courses, bool rows,
                        const std::vector<bool>& sound, const DiscrepancyOptions& options) {
  return LineTest(measured, courses, rows, sound).run(options);
}

}  // namespace fsr::discrepancy
