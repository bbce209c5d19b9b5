#include "discrepancy/samples/line_faults.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "statistics/median.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kSpans[] = {2, 8, 32};                // scans on each side of a step
constexpr std::size_t kFewestLines = 3, kFewestTaxels = 3;  // fewer have no neighbours, or are no line
constexpr float kMostDeviation = 1;  // a deviation beyond the taxel's range says no more

std::size_t strideOf(std::size_t span) {
  return std::max<std::size_t>(1, span / 4);
}

// Steps of the taxels: mean deviation over the scans after a place less the mean over those before it.
struct Steps {
  struct Place {
    std::size_t visit, scan, span;
  };
  std::vector<Place> places;
  Eigen::MatrixXf of;         // [places x taxels], in units of the usual largest step of that span
  std::vector<double> usual;  // by span [unit of the courses]
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
  void step();
  Eigen::MatrixXf contrast(const std::vector<std::size_t>& order) const;
  bool together(Eigen::Index place, std::size_t line) const;
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
  Steps steps_;
};

bool LineTest::prepare() {
  members_.assign(lines_, 0);
  for (const std::size_t t : taxels_) ++members_[lineOf(t)];
  std::vector<std::size_t> whole;
  for (std::size_t l = 0; l < lines_; ++l) {
    if (members_[l] >= kFewestTaxels) whole.push_back(l);
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

void LineTest::step() {
  for (const std::size_t span : kSpans) {
    for (std::size_t v = 0; v < courses_.size(); ++v) {
      for (std::size_t at = span; at + span <= courses_[v].scans(); at += strideOf(span))
        steps_.places.push_back({v, at, span});
    }
  }
  const auto places = static_cast<Eigen::Index>(steps_.places.size());
  steps_.of.resize(places, static_cast<Eigen::Index>(taxels_.size()));
  std::vector<std::vector<double>> sums(courses_.size());
  for (std::size_t k = 0; k < taxels_.size(); ++k) {
    for (std::size_t v = 0; v < courses_.size(); ++v) {
      sums[v].assign(courses_[v].scans() + 1, 0);
      for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
        const double now =
            std::clamp(courses_[v].deviation(taxels_[k], i), -double{kMostDeviation}, double{kMostDeviation});
        sums[v][i + 1] = sums[v][i] + now;
      }
    }
    for (Eigen::Index p = 0; p < places; ++p) {
      const Steps::Place& at = steps_.places[static_cast<std::size_t>(p)];
      const std::vector<double>& sum = sums[at.visit];
      steps_.of(p, static_cast<Eigen::Index>(k)) =
          static_cast<float>((sum[at.scan + at.span] - 2 * sum[at.scan] + sum[at.scan - at.span]) /
                             static_cast<double>(at.span));
    }
  }
  // Steps of each span in units of the taxels' usual largest one.
  Eigen::Index from = 0;
  for (const std::size_t span : kSpans) {
    Eigen::Index to = from;
    while (to < places && steps_.places[static_cast<std::size_t>(to)].span == span) ++to;
    std::vector<double> largest;
    for (Eigen::Index k = 0; k < steps_.of.cols() && to > from; ++k)
      largest.push_back(static_cast<double>(steps_.of.col(k).segment(from, to - from).cwiseAbs().maxCoeff()));
    steps_.usual.push_back(std::max(1e-9, statistics::upperMedian(largest, 0)));
    steps_.of.middleRows(from, to - from) /= static_cast<float>(steps_.usual.back());
    from = to;
  }
}

// Steps of each line less those of the lines beside it, in units of their noise. `order`: which taxel stands
// at the place of each one.
Eigen::MatrixXf LineTest::contrast(const std::vector<std::size_t>& order) const {
  const auto lines = static_cast<Eigen::Index>(lines_);
  Eigen::MatrixXf mean = Eigen::MatrixXf::Zero(steps_.of.rows(), lines);
  for (std::size_t k = 0; k < taxels_.size(); ++k) {
    const std::size_t line = lineOf(taxels_[k]);
    mean.col(static_cast<Eigen::Index>(line)) +=
        steps_.of.col(static_cast<Eigen::Index>(order[k])) / static_cast<float>(members_[line]);
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

// Whether the taxels of a line make the step together: their median step is at least half the mean.
bool LineTest::together(Eigen::Index place, std::size_t line) const {
  std::vector<double> own;
  double mean = 0;
  for (std::size_t k = 0; k < taxels_.size(); ++k) {
    if (lineOf(taxels_[k]) != line) continue;
    own.push_back(static_cast<double>(steps_.of(place, static_cast<Eigen::Index>(k))));
    mean += own.back() / members_[line];
  }
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
    for (std::size_t i = 0; i < course.size(); ++i) course[i] += weight * courses_[visit].deviation(t, i);
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
    const double limit = least * steps_.usual[s];
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
    if (std::abs(mean - usual) < least * steps_.usual[s] / 2) continue;
    std::fill(failing.begin() + static_cast<std::ptrdiff_t>(cuts[c]),
              failing.begin() + static_cast<std::ptrdiff_t>(cuts[c + 1]), true);
  }
  return failing;
}

LineFault LineTest::run(const DiscrepancyOptions& options) {
  LineFault fault;
  if (!prepare()) return fault;
  step();
  if (steps_.places.empty()) return fault;
  std::vector<std::size_t> order(taxels_.size());
  std::iota(order.begin(), order.end(), 0);
  const Eigen::MatrixXf steps = contrast(order).cwiseAbs();
  Eigen::Index place = 0, line = 0;
  const float largest = steps.maxCoeff(&place, &line);
  std::vector<float> by_chance;
  std::size_t beyond = 0;
  for (std::size_t draw = 0; draw < options.null_draws; ++draw) {
    const statistics::RandomStream stream =
        statistics::randomStream(options.seed, rows_ ? "rows" : "columns", draw);
    for (std::size_t k = order.size(); k-- > 1;)
      std::swap(order[k], order[static_cast<std::size_t>(stream.uniform(k) * static_cast<double>(k + 1))]);
    by_chance.push_back(contrast(order).cwiseAbs().maxCoeff());
    beyond += by_chance.back() >= largest;
    // No further draw can bring it below the level.
    if (2 * static_cast<double>(1 + beyond) > options.level * static_cast<double>(options.null_draws + 1))
      break;
  }
  // Rows and columns are two tests.
  fault.p = std::min(1.0, 2 * static_cast<double>(1 + beyond) / static_cast<double>(by_chance.size() + 1));
  fault.line = static_cast<std::size_t>(line);
  if (fault.p > options.level || !together(place, fault.line)) return fault;
  // Largest step of the lines that are not beside it. Permuted taxels would hold the fault.
  float others = 0;
  for (std::size_t l = 0; l < lines_; ++l) {
    const auto& beside = beside_[fault.line];
    if (l != fault.line && !std::count(beside.begin(), beside.end(), l))
      others = std::max(others, steps.col(static_cast<Eigen::Index>(l)).maxCoeff());
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
