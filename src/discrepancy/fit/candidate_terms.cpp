#include "discrepancy/fit/candidate_terms.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kPressureHats = 5;
constexpr std::size_t kTimeHats = 4;  // over clock time, in each visit
constexpr double kReversalStart = 1;  // first knot of the time since a reversal [s]
constexpr double kReversalStep = 5;   // factor from knot to knot
constexpr std::size_t kReversalHats = 4;
constexpr std::size_t kDistanceHats = 4;  // over the root of the change of pressure since a reversal

// Triangle around 0 that reaches 0 at -1 and at 1.
double hat(double x) {
  return std::max(0.0, 1 - std::abs(x));
}

// The variables of the columns, at each sample.
struct Covariates {
  std::vector<double> pressure;      // share of the highest pressure
  std::vector<double> rate;          // in units of the usual rate of a ramp
  std::vector<double> since;         // time since a reversal [s]
  std::vector<double> valley, peak;  // last turning points, shares of the highest pressure
  std::vector<double> in_visit;      // position in the visit, 0 .. 1
  std::vector<double> cycle;         // number of cycles since the visit began
  std::vector<double> bend;          // share of the largest curvature
};

double usualRate(const Measured& measured) {
  std::vector<double> rates;
  for (const double rate : measured.rate) rates.push_back(std::abs(rate));
  const auto upper = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() * 3 / 4);
  std::nth_element(rates.begin(), upper, rates.end());
  return std::max(*upper, 1.0);
}

double bendOf(const Visit& visit) {
  double sum = 0;
  for (const matrix::Curvature& c : visit.surface.curvature) sum += std::abs(matrix::principalCurvature(c));
  return sum / static_cast<double>(visit.surface.curvature.size());
}

// Appends the time since the last reversal and the last turning points for the samples of one visit.
void followTurns(const Measured& measured, const Visit& visit, double highest, Covariates& covariates) {
  double turned = measured.time[visit.first], valley = measured.pressure[visit.first], peak = valley;
  double low = valley, high = valley;
  for (std::size_t i = visit.first; i < visit.last; ++i) {
    const double now = measured.pressure[i];
    if (i > visit.first && measured.direction[i] != measured.direction[i - 1]) {
      turned = measured.time[i];
      if (measured.direction[i] > 0) valley = low;
      if (measured.direction[i] < 0) peak = high;
      low = high = now;
    }
    low = std::min(low, now);
    high = std::max(high, now);
    covariates.since.push_back(measured.time[i] - turned);
    covariates.valley.push_back(valley / highest);
    covariates.peak.push_back(peak / highest);
  }
}

Covariates covariatesOf(const Measured& measured) {
  Covariates covariates;
  const double highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  const double usual = usualRate(measured);
  double most_bend = 1e-9;
  for (const Visit& visit : measured.visits) most_bend = std::max(most_bend, bendOf(visit));
  for (const Visit& visit : measured.visits) {
    followTurns(measured, visit, highest, covariates);
    const double bend = bendOf(visit) / most_bend;
    const auto samples = static_cast<double>(visit.last - visit.first);
    for (std::size_t i = visit.first; i < visit.last; ++i) {
      covariates.pressure.push_back(measured.pressure[i] / highest);
      covariates.rate.push_back(measured.rate[i] / usual);
      covariates.in_visit.push_back(static_cast<double>(i - visit.first) / samples);
      covariates.cycle.push_back(static_cast<double>(measured.cycle[i] - measured.cycle[visit.first]));
      covariates.bend.push_back(bend);
    }
  }
  return covariates;
}

using Function = std::function<double(std::size_t)>;

class Terms {
 public:
  Terms(const Measured& measured, const StaticFit& fit) : measured_(measured), fit_(fit) {}

  void load(const Function& f) { add(f, fit_.slope()); }
  void gain(const Function& f) { add(f, fit_.netCurve()); }
  void zero(const Function& f) { add(f, Trace::Ones(fit_.netCurve().size())); }
  void loadAndGain(const Function& f) {
    load(f);
    gain(f);
  }
  std::vector<Trace> take() { return std::move(columns_); }

 private:
  void add(const Function& f, const Trace& through) {
    Trace column(through.size());
    for (std::size_t i = 0; i < measured_.samples(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      column[at] = f(i) * through[at];
    }
    const double norm = column.norm();
    if (norm > 0) column *= std::sqrt(static_cast<double>(column.size())) / norm;
    columns_.push_back(std::move(column));
  }
  const Measured& measured_;
  const StaticFit& fit_;
  std::vector<Trace> columns_;
};

using Fill = std::function<void(Terms&, const std::function<double(std::size_t)>& weight)>;

Fill byDirection(const Measured& m, const Covariates& c) {
  return [&](Terms& terms, const Function& weight) {
    for (std::size_t k = 0; k < kPressureHats; ++k) {
      const double centre = static_cast<double>(k) / (kPressureHats - 1);
      terms.load([&, centre](std::size_t i) {
        return weight(i) * m.direction[i] * hat((c.pressure[i] - centre) * (kPressureHats - 1));
      });
    }
  };
}

Fill byRate(const Covariates& c) {
  return [&](Terms& terms, const Function& weight) {
    const auto sized = [&](std::size_t i) { return std::abs(c.rate[i]); };
    terms.loadAndGain([&](std::size_t i) { return weight(i) * c.rate[i]; });
    terms.loadAndGain([&](std::size_t i) { return weight(i) * sized(i); });
    terms.loadAndGain([&](std::size_t i) { return weight(i) * sized(i) / (0.3 + sized(i)); });
    terms.loadAndGain([&](std::size_t i) { return weight(i) * c.rate[i] / (0.3 + sized(i)); });
  };
}

Fill bySinceReversal(const Measured& m, const Covariates& c) {
  return [&](Terms& terms, const Function& weight) {
    for (std::size_t k = 0; k < kReversalHats; ++k) {
      for (const int direction : {-1, 1}) {
        terms.loadAndGain([&, k, direction](std::size_t i) {
          if (m.direction[i] != direction) return 0.0;
          const double logarithm = std::log(1 + c.since[i] / kReversalStart) / std::log(kReversalStep);
          return weight(i) * hat(logarithm - static_cast<double>(k) - 0.5);
        });
      }
    }
  };
}

Fill byExtremes(const Measured& m, const Covariates& c) {
  return [&](Terms& terms, const Function& weight) {
    for (const int direction : {-1, 1}) {
      const auto on = [&, direction](std::size_t i) { return m.direction[i] == direction ? weight(i) : 0.0; };
      terms.loadAndGain([&](std::size_t i) { return on(i) * c.valley[i]; });
      terms.loadAndGain([&](std::size_t i) { return on(i) * c.peak[i]; });
      terms.gain([&](std::size_t i) { return on(i) * c.valley[i] * c.valley[i]; });
    }
    terms.gain([&](std::size_t i) { return weight(i) * std::min(c.valley[i], c.pressure[i]); });
    // A loop that does not depend on the rate is, after a reversal, a function of the change of pressure.
    for (std::size_t k = 0; k < kDistanceHats; ++k) {
      for (const int direction : {-1, 1}) {
        terms.load([&, k, direction](std::size_t i) {
          if (m.direction[i] != direction) return 0.0;
          const double turned = direction > 0 ? c.valley[i] : c.peak[i];
          const double distance = std::sqrt(std::abs(c.pressure[i] - turned));
          return weight(i) * hat(distance * (kDistanceHats - 1) - static_cast<double>(k));
        });
      }
    }
  };
}

Fill byCycle(const Covariates& c) {
  return [&](Terms& terms, const Function& weight) {
    for (const double length : {1.0, 3.0}) {
      terms.loadAndGain([&, length](std::size_t i) { return weight(i) * std::exp(-c.cycle[i] / length); });
    }
  };
}

Fill byClock(const Measured& m, const Covariates& c) {
  return [&](Terms& terms, const Function&) {
    for (std::size_t v = 0; v < m.visits.size(); ++v) {
      for (std::size_t k = 0; k < kTimeHats; ++k) {
        const auto shape = [&, v, k](std::size_t i) {
          return m.visit[i] == v ? hat(c.in_visit[i] * (kTimeHats - 1) - static_cast<double>(k)) : 0.0;
        };
        terms.zero(shape);
        terms.gain(shape);
      }
    }
  };
}

}  // namespace

std::vector<GenericTerms> genericTerms(const Measured& measured, const StaticFit& fit) {
  const Covariates c = covariatesOf(measured);
  const std::vector<std::pair<std::vector<simulation::Covariate>, Fill>> groups = {
      {{simulation::Covariate::kDirection, simulation::Covariate::kPressure}, byDirection(measured, c)},
      {{simulation::Covariate::kPressureRate}, byRate(c)},
      {{simulation::Covariate::kTimeSinceReversal}, bySinceReversal(measured, c)},
      {{simulation::Covariate::kPreviousExtremes}, byExtremes(measured, c)},
      {{simulation::Covariate::kCycle}, byCycle(c)},
      {{simulation::Covariate::kClockTime}, byClock(measured, c)},
  };
  std::vector<GenericTerms> all;
  for (const auto& [covariates, fill] : groups) {
    Terms terms(measured, fit);
    fill(terms, [](std::size_t) { return 1.0; });
    all.push_back({covariates, terms.take()});
    if (measured.classes.size() < 2 || covariates.front() == simulation::Covariate::kClockTime) continue;
    Terms bent(measured, fit);
    fill(bent, [&](std::size_t i) { return c.bend[i]; });
    GenericTerms with = all.back();
    with.covariates.push_back(simulation::Covariate::kCurvature);
    for (Trace& column : bent.take()) with.columns.push_back(std::move(column));
    all.push_back(std::move(with));
  }
  return all;
}

namespace {

constexpr double kHour = 3600;       // [s]
constexpr std::size_t kNodes = 48;   // times at which the modes are computed; straight between them
constexpr Eigen::Index kModes = 24;  // leave 1 % of the variance of a walk

using Covariance = std::function<double(double, double)>;  // of two times [h]

// A walk that begins at 0 and is pulled back within `fades` hours.
Covariance walk(double fades) {
  if (std::isinf(fades)) return [](double a, double b) { return std::min(a, b); };
  return [fades](double a, double b) {
    return fades / 2 * (std::exp(-std::abs(a - b) / fades) - std::exp(-(a + b) / fades));
  };
}

// The integral of a walk, and a straight line, over `whole` hours.
Covariance trend(double whole) {
  return [whole](double a, double b) {
    const double least = std::min(a, b) / whole, most = std::max(a, b) / whole;
    return whole * (least * most + least * least * (3 * most - least) / 6);
  };
}

// The clock times of the recordings, from 0 [h], and some of them as nodes.
class Clock {
 public:
  explicit Clock(const Measured& measured) {
    const std::size_t samples = measured.samples();
    for (std::size_t i = 0; i < samples; ++i) time_.push_back((measured.time[i] - measured.time[0]) / kHour);
    for (std::size_t k = 0; k < kNodes; ++k) {
      const double time = time_[k * (samples - 1) / (kNodes - 1)];
      if (nodes_.empty() || time > nodes_.back()) nodes_.push_back(time);
    }
  }

  double whole() const { return nodes_.back(); }

  // The first modes of a process, each as long as its standard deviation [samples x modes].
  Eigen::MatrixXd modes(const Covariance& of) const {
    const auto n = static_cast<Eigen::Index>(nodes_.size());
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b < n; ++b)
        covariance(a, b) = of(nodes_[static_cast<std::size_t>(a)], nodes_[static_cast<std::size_t>(b)]);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
    const Eigen::Index number = std::min(n, kModes);
    const Eigen::VectorXd size = solver.eigenvalues().tail(number).cwiseMax(0.0).cwiseSqrt();
    return between(solver.eigenvectors().rightCols(number) * size.asDiagonal());
  }

 private:
  Eigen::MatrixXd between(const Eigen::MatrixXd& at_nodes) const {
    Eigen::MatrixXd result(static_cast<Eigen::Index>(time_.size()), at_nodes.cols());
    std::size_t node = 0;
    for (std::size_t i = 0; i < time_.size(); ++i) {
      while (node + 2 < nodes_.size() && nodes_[node + 1] <= time_[i]) ++node;
      const std::size_t next = std::min(node + 1, nodes_.size() - 1);
      const double length = nodes_[next] - nodes_[node];
      const double share = length > 0 ? std::clamp((time_[i] - nodes_[node]) / length, 0.0, 1.0) : 0;
      result.row(static_cast<Eigen::Index>(i)) = (1 - share) * at_nodes.row(static_cast<Eigen::Index>(node)) +
                                                 share * at_nodes.row(static_cast<Eigen::Index>(next));
    }
    return result;
  }

  std::vector<double> time_;   // of each sample
  std::vector<double> nodes_;  // rising
};

// Share of the taxels in use that are at no end of the converter's range, where a reading does not follow its
// zero.
Trace shareWithinRange(const Measured& measured) {
  Trace share(static_cast<Eigen::Index>(measured.samples()));
  std::vector<double> readings;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    measured.recorded(i, readings);
    double within = 0;
    for (std::size_t t = 0; t < readings.size(); ++t)
      within += measured.used[t] && readings[t] > 0 && readings[t] < 1 ? 1 : 0;
    share[static_cast<Eigen::Index>(i)] = within / static_cast<double>(measured.usedTaxels());
  }
  return share;
}

// `moved`: change of the mean reading by the walk.
std::vector<Trace> columnsOf(const Eigen::MatrixXd& modes, const Trace& moved) {
  std::vector<Trace> columns;
  for (Eigen::Index k = 0; k < modes.cols(); ++k) columns.push_back(modes.col(k).cwiseProduct(moved));
  return columns;
}

}  // namespace

std::vector<RandomCourse> randomCourses(const Measured& measured, const StaticFit& fit,
                                        const simulation::EffectInfo& info) {
  std::vector<RandomCourse> courses;
  const std::vector<simulation::EffectParameter> steps = simulation::walks(info);
  if (steps.empty()) return courses;
  const Clock clock(measured);
  if (!(clock.whole() > 0)) return courses;
  for (const simulation::EffectParameter& step : steps) {
    const Trace moved = step.walk == simulation::Walk::kGain ? fit.curve() : shareWithinRange(measured);
    const simulation::EffectParameter& fades = simulation::parameter(info, step.fades_over);
    for (const double seconds : fades.tried) {
      courses.push_back(
          {step.name, {{fades.name, seconds}}, columnsOf(clock.modes(walk(seconds / kHour)), moved)});
    }
    courses.push_back({"", {}, columnsOf(clock.modes(trend(clock.whole())), moved)});
  }
  return courses;
}

}  // namespace fsr::discrepancy
