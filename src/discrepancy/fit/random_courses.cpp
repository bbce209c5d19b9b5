#include "discrepancy/fit/random_courses.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fsr::discrepancy {

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
