#include "discrepancy/samples/taxel_courses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

using Kind = TaxelFault::Kind;

constexpr std::size_t kFewestForQuartiles = 8;  // fewer have no quartiles
// Quantiles of Gumbel's standard distribution: median, and difference of the quartiles.
constexpr double kGumbelMedian = 0.36651, kGumbelQuartiles = 1.57253;
// Least scale of the logarithm of the taxels' largest deviations: they differ by some per cent by chance
// alone, and by steps of the converter.
constexpr double kLeastScale = 0.1;
// Response to the others, relative to the usual one, below which a taxel does not follow them.
constexpr double kFollowsOthers = 0.3;
// Largest memory of the deviations from one scan to the next. What lasts longer is taken up by the models.
constexpr double kMostMemory = 0.8;
// Share of the scans in which a frozen reading changes all the same.
constexpr double kThaws = 0.01;
// Level of a fault [range of the taxel]: what is closer to a level than this is at it.
constexpr double kAtLevel = 0.01;
// Decays that are tried, in time constants over the length of the spell. 0 = a step.
constexpr double kDecays[] = {0, 0.5, 1, 1.5, 2, 3, 4, 6, 8, 16, 32};

struct Spell {
  std::size_t visit, first, last;  // `last` excluded
};

// Distribution of the logarithm of the largest deviation over the taxels.
struct Gumbel {
  double location = 0, scale = kLeastScale;

  explicit Gumbel(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
      return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    scale = std::max(kLeastScale, (at(0.75) - at(0.25)) / kGumbelQuartiles);
    location = at(0.5) - kGumbelMedian * scale;
  }
  double p(double value) const { return -std::expm1(-std::exp(-(value - location) / scale)); }
  // Value that only a share p of all exceed.
  double exceededBy(double p) const { return location - scale * std::log(-std::log1p(-p)); }
};

// Sums of a taxel's deviations from the first scan of a visit to each scan, [visits][scans + 1].
using Sums = std::vector<std::vector<double>>;

// Largest mean deviation over `span` scans.
double largest(const Sums& sums, std::size_t span) {
  double most = 0;
  for (const std::vector<double>& sum : sums) {
    for (std::size_t i = 0; i + span < sum.size(); ++i)
      most = std::max(most, std::abs(sum[i + span] - sum[i]));
  }
  return most / static_cast<double>(span);
}

class TaxelTest {
 public:
  TaxelTest(const Measured& measured, const std::vector<VisitCourses>& courses,
            const std::vector<bool>& sound, const DiscrepancyOptions& options)
      : measured_(measured), courses_(courses), options_(options) {
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (sound[t]) taxels_.push_back(t);
    }
    zero_ = std::numeric_limits<double>::infinity();
    for (const VisitCourses& visit : courses) {
      for (const std::size_t t : taxels_) zero_ = std::min(zero_, visit.lowest[t]);
    }
  }
  std::vector<TaxelFault> run();

 private:
  void measure();
  Sums sumsOf(std::size_t taxel) const;
  std::vector<std::vector<bool>> failing(std::size_t taxel) const;
  void join(std::size_t taxel, std::size_t visit, std::vector<bool>& flags) const;
  void judge(TaxelFault& fault) const;

  const Measured& measured_;
  const std::vector<VisitCourses>& courses_;
  const DiscrepancyOptions& options_;
  std::vector<std::size_t> taxels_;
  double zero_ = 0;  // reading without load [share of full scale]
  std::vector<std::size_t> spans_;
  std::vector<std::vector<double>> largest_;  // [spans][taxels_]
  std::vector<double> limit_;                 // of the mean deviation over a span, [spans]
};

Sums TaxelTest::sumsOf(std::size_t taxel) const {
  Sums sums;
  for (const VisitCourses& visit : courses_) {
    sums.emplace_back(visit.scans() + 1, 0);
    std::vector<double>& sum = sums.back();
    visit.deviations(taxel, 0, visit.scans(), sum.data() + 1);
    for (std::size_t i = 0; i < visit.scans(); ++i) sum[i + 1] = sum[i] + sum[i + 1];
  }
  return sums;
}

void TaxelTest::measure() {
  std::size_t longest = 0;
  for (const VisitCourses& visit : courses_) longest = std::max(longest, visit.scans());
  for (std::size_t span = 2; span <= longest; span *= 2) spans_.push_back(span);
  largest_.resize(spans_.size());
  for (const std::size_t t : taxels_) {
    const Sums sums = sumsOf(t);  // those of all taxels would take four times the memory of the counts
    for (std::size_t s = 0; s < spans_.size(); ++s)
      largest_[s].push_back(std::log(std::max(1e-6, largest(sums, spans_[s]))));
  }
  const auto tests = static_cast<double>(taxels_.size() * spans_.size());
  for (const std::vector<double>& sizes : largest_)
    limit_.push_back(std::exp(Gumbel(sizes).exceededBy(options_.level / tests)));
}

// Joins spells of one fault: between them it would not have shown, or it shows in most scans.
void TaxelTest::join(std::size_t taxel, std::size_t visit, std::vector<bool>& flags) const {
  TaxelCourse course(courses_[visit], taxel);
  std::size_t last = flags.size(), run = 0;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (!flags[i]) continue;
    std::size_t end = i;
    while (end < flags.size() && flags[end]) ++end;
    if (last < flags.size() && i > last) {
      bool hidden = true;
      for (std::size_t g = last; g < i && hidden; ++g)
        hidden =
            std::abs(course.expected(g)) < kFollowsOthers || std::abs(course.deviation(g)) > kFollowsOthers;
      if (hidden || i - last <= std::min(run, end - i) / 2)
        std::fill(flags.begin() + static_cast<std::ptrdiff_t>(last),
                  flags.begin() + static_cast<std::ptrdiff_t>(i), true);
    }
    last = end;
    run = end - i;
    i = end;
  }
}

// Spells by the shortest span over which the taxel is an outlier: a mean over a longer one also reaches its
// limit beside a spell.
std::vector<std::vector<bool>> TaxelTest::failing(std::size_t k) const {
  std::size_t shortest = 0;
  while (shortest + 1 < spans_.size() && std::exp(largest_[shortest][k]) < limit_[shortest]) ++shortest;
  std::vector<std::vector<bool>> all;
  const Sums sums = sumsOf(taxels_[k]);
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    std::vector<bool> flags(courses_[v].scans(), false);
    const std::vector<double>& sum = sums[v];
    const std::size_t span = spans_[shortest];
    for (std::size_t i = 0; i + span < sum.size(); ++i) {
      if (std::abs(sum[i + span] - sum[i]) < limit_[shortest] * static_cast<double>(span)) continue;
      for (std::size_t j = i; j < i + span; ++j) {
        if (std::abs(sum[j + 1] - sum[j]) > limit_[shortest] / 2) flags[j] = true;
      }
    }
    join(taxels_[k], v, flags);
    all.push_back(std::move(flags));
  }
  return all;
}

template <typename Use>
void eachRun(const std::vector<bool>& flags, Use use) {
  for (std::size_t from = 0; from < flags.size();) {
    std::size_t to = from;
    while (to < flags.size() && flags[to] == flags[from]) ++to;
    if (flags[from]) use(from, to);
    from = to;
  }
}

// Readings of a taxel in a spell, and models of them.
class SpellFit {
 public:
  SpellFit(const VisitCourses& visit, std::size_t taxel, const Spell& spell, double zero, double noise)
      : n_(static_cast<Eigen::Index>(spell.last - spell.first)) {
    reading_.resize(n_);
    expected_.resize(n_);
    place_.resize(n_);
    zero_ = (zero - visit.lowest[taxel]) / visit.unit[taxel];
    TaxelCourse course(visit, taxel);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const std::size_t scan = spell.first + static_cast<std::size_t>(i);
      reading_[i] = static_cast<double>(course.reading(scan));
      expected_[i] = static_cast<double>(course.expected(scan));
      place_[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(n_);
    }
    nothing_ = -visit.lowest[taxel] / visit.unit[taxel];
    floor_ = static_cast<double>(n_) * (noise * noise + kAtLevel * kAtLevel);
  }
  double square() const { return floor_ + (reading_ - expected_).squaredNorm(); }
  // The reading goes to that without load, which is between 0 counts and the lowest reading of the sheet: a
  // share of what the others say, which ends below kFollowsOthers.
  double dead(double& parameters) const {
    double best = INFINITY, costs = 0;
    for (const double level : {zero_, nothing_}) {
      const Eigen::VectorXd y = reading_.array() - level, f = expected_.array() - level;
      for (const double decay : kDecays) {
        const Eigen::VectorXd x = f.array() * (-decay * place_.array()).exp();
        const double most = std::min(1.0, kFollowsOthers * std::exp(decay));
        const double a = x.squaredNorm() > 0 ? std::clamp(x.dot(y) / x.squaredNorm(), 0.0, most) : 0;
        keepBetter((y - a * x).squaredNorm(), decay > 0 ? 2 : 1, best, costs);
      }
    }
    parameters = costs;
    return floor_ + best;
  }
  // The reading goes to some level, whatever the others say.
  double stuck(double& parameters) const {
    double best = INFINITY, costs = 0;
    for (const double decay : kDecays) {
      Eigen::MatrixXd x(n_, decay > 0 ? 2 : 1);
      x.col(0).setOnes();
      if (decay > 0) x.col(1) = (-decay * place_.array()).exp();
      const Eigen::VectorXd left = reading_ - x * x.colPivHouseholderQr().solve(reading_);
      keepBetter(left.squaredNorm(), decay > 0 ? 3 : 1, best, costs);
      if (std::exp(-decay) > kFollowsOthers) continue;
      // It leaves the others for that level by and by.
      const Eigen::VectorXd still = (-decay * place_.array()).exp(), moved = 1 - still.array();
      const Eigen::VectorXd y = reading_.array() - still.array() * expected_.array();
      keepBetter((y - moved * (moved.dot(y) / moved.squaredNorm())).squaredNorm(), 2, best, costs);
    }
    parameters = costs;
    return floor_ + best;
  }
  // The reading follows the others, by at least kFollowsOthers of the usual response, beside an offset that
  // may drift.
  double follows(double& parameters) const {
    Eigen::MatrixXd x(n_, 3);
    x.col(0).setOnes();
    x.col(1) = place_;
    x.col(2) = expected_;
    parameters = 3;
    const Eigen::VectorXd fit = x.colPivHouseholderQr().solve(reading_);
    if (fit[2] >= kFollowsOthers) return floor_ + (reading_ - x * fit).squaredNorm();
    const Eigen::VectorXd y = reading_ - kFollowsOthers * expected_;
    parameters = 2;
    return floor_ + (y - x.leftCols(2) * x.leftCols(2).colPivHouseholderQr().solve(y)).squaredNorm();
  }
  // Share of the scans with the same reading as the scan before.
  double constant() const {
    double same = 0;
    for (Eigen::Index i = 1; i < n_; ++i) same += reading_[i] == reading_[i - 1];
    return n_ > 1 ? same / static_cast<double>(n_ - 1) : 0;
  }
  bool atZero() const { return reading_.mean() - zero_ < 5 * kAtLevel; }
  double scans() const { return static_cast<double>(n_); }

 private:
  static void keepBetter(double square, double parameters, double& best, double& costs) {
    if (square < best) best = square, costs = parameters;
  }

  Eigen::Index n_;
  Eigen::VectorXd reading_, expected_, place_;
  double zero_ = 0, nothing_ = 0, floor_ = 0;
};

// Names what a taxel does in its spells: the logarithms of the likelihoods of the three models, each with its
// own noise, compared by Schwarz's criterion over independent scans.
void TaxelTest::judge(TaxelFault& fault) const {
  double square = 0, dead = 0, stuck = 0, scans = 0, better = 0, dead_better = 0;
  double changes = 0, steps = 0, squares_dead = 0, squares_stuck = 0;
  std::vector<double> sizes;
  double product = 0, squares = 0;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    TaxelCourse course(courses_[v], fault.taxel);
    double before = 0;  // deviation and reading in the last scan that does not fail
    float reading_before = 0;
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      if (fault.failing[v][i]) continue;
      const double deviation = course.deviation(i), last = std::exchange(before, deviation);
      const float reading = course.reading(i), last_reading = std::exchange(reading_before, reading);
      sizes.push_back(std::abs(deviation));
      if (i == 0 || fault.failing[v][i - 1]) continue;
      product += deviation * last;
      squares += std::pow(deviation, 2);
      changes += reading != last_reading;
      ++steps;
    }
  }
  const double noise = statistics::kDeviationPerMedian * statistics::upperMedian(sizes, 0);
  const double memory = squares > 0 ? std::clamp(product / squares, 0.0, kMostMemory) : 0;
  const double independent = (1 - memory) / (1 + memory);  // share of the scans
  const double same_by_chance = (steps - changes + 1) / (steps + 2);
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    eachRun(fault.failing[v], [&](std::size_t from, std::size_t to) {
      const SpellFit fit(courses_[v], fault.taxel, {v, from, to}, zero_, noise);
      double cost[3];
      const double d = fit.dead(cost[0]), s = fit.stuck(cost[1]), f = fit.follows(cost[2]);
      const double n = std::max(1.0, independent * fit.scans());
      const double log_n = std::log(n + 1);
      double as_dead = -n / 2 * std::log(d) - cost[0] / 2 * log_n;
      double as_stuck = -n / 2 * std::log(s) - cost[1] / 2 * log_n;
      const double as_other = -n / 2 * std::log(f) - cost[2] / 2 * log_n;
      // A code that never changes says more than a level: a sound taxel keeps it by chance. At the reading
      // without load it does not say which of the two.
      const double kept = fit.constant();
      const double frozen =
          std::max(0.0, (fit.scans() - 1) * (kept * std::log((1 - kThaws) / same_by_chance) +
                                             (1 - kept) * std::log(kThaws / (1 - same_by_chance))));
      as_stuck += frozen;
      if (fit.atZero()) as_dead += frozen;
      square += fit.square();
      dead += d;
      stuck += s;
      scans += fit.scans();
      (as_dead >= as_stuck ? squares_dead : squares_stuck) += fit.square();
      better += std::max(as_dead, as_stuck) - as_other;
      dead_better += as_dead - as_stuck;
    });
  }
  if (better < -std::log(options_.level) || scans == 0) return;
  const bool is_dead = dead_better >= 0;
  // Spells of two kinds are neither.
  if ((is_dead ? squares_stuck : squares_dead) > (1 - options_.wrong_form_below) * square) return;
  const double left = is_dead ? dead : stuck;
  if (left > (1 - options_.wrong_form_below) * square) return;
  fault.kind = is_dead ? Kind::kDead : Kind::kStuck;
}

std::vector<TaxelFault> TaxelTest::run() {
  std::vector<TaxelFault> faults;
  if (taxels_.size() < kFewestForQuartiles) return faults;
  measure();
  const auto tests = static_cast<double>(taxels_.size() * spans_.size());
  for (std::size_t k = 0; k < taxels_.size(); ++k) {
    double p = 1;
    for (std::size_t s = 0; s < spans_.size(); ++s) {
      p = std::min(p, Gumbel(largest_[s]).p(largest_[s][k]));
    }
    TaxelFault fault;
    fault.taxel = taxels_[k];
    fault.p = std::min(1.0, p * tests);
    if (fault.p > options_.level) continue;
    fault.failing = failing(k);
    judge(fault);
    faults.push_back(std::move(fault));
  }
  return faults;
}

}  // namespace

std::vector<TaxelFault> findTaxelFaults(const Measured& measured, const std::vector<VisitCourses>& courses,
                                        const std::vector<bool>& sound, const DiscrepancyOptions& options) {
  return TaxelTest(measured, courses, sound, options).run();
}

}  // namespace fsr::discrepancy
