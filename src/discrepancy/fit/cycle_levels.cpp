#include "discrepancy/fit/cycle_levels.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "discrepancy/samples/held_out.h"

namespace fsr::discrepancy {

namespace {

constexpr double kSingular = 1e-9;  // share of the largest eigenvalue; smaller ones count as 0
constexpr double kMoved = 0.2;      // a room temperature that changes by less counts as constant [K]
constexpr Eigen::Index kMoreThanTerms = 6;

double mean(const std::vector<double>& values, const MeasuredCycle& cycle) {
  double sum = 0;
  for (std::size_t i = cycle.first; i < cycle.last; ++i) sum += values[i];
  return sum / static_cast<double>(cycle.last - cycle.first);
}

}  // namespace

CycleLevels::CycleLevels(const Measured& measured, const StaticFit& fit, const Trace& residual) {
  judge(measured, fit, residual);
  group(measured);
  centre(levels_);
  plan(measured);
}

void CycleLevels::judge(const Measured& measured, const StaticFit& fit, const Trace& residual) {
  std::vector<Eigen::Vector2d> levels;
  gram_.setZero();
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured.cycles[c];
    Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (auto i = static_cast<Eigen::Index>(cycle.first); i < static_cast<Eigen::Index>(cycle.last); ++i) {
      const Eigen::Vector2d x(fit.netCurve()[i], 1);
      gram += x * x.transpose();
      right += x * residual[i];
    }
    const bool loaded = gram.determinant() > kSingular * gram.trace() * gram.trace();
    if (cycle.use == CycleUse::kHoldOut || !loaded) continue;
    cycles_.push_back(c);
    visit_.push_back(cycle.visit);
    levels.push_back(gram.ldlt().solve(right));
    gram_ += gram;
    samples_ += static_cast<double>(cycle.last - cycle.first);
  }
  levels_.resize(static_cast<Eigen::Index>(levels.size()), 2);
  for (std::size_t c = 0; c < levels.size(); ++c) levels_.row(static_cast<Eigen::Index>(c)) = levels[c];
}

void CycleLevels::group(const Measured& measured) {
  std::vector<std::size_t> protocol(measured.cycles.size(), 0);
  const std::vector<Part> parts = partsByProtocol(measured);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const std::size_t c : parts[p].cycles) protocol[c] = p + 1;
  }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> numbers;
  for (const std::size_t c : cycles_) {
    const std::size_t surface = measured.visits[measured.cycles[c].visit].curvature_class;
    group_.push_back(numbers.emplace(std::make_pair(surface, protocol[c]), numbers.size()).first->second);
  }
  groups_ = numbers.size();
}

void CycleLevels::centre(Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(groups_), rows.cols());
  std::vector<double> members(groups_, 0.0);
  for (std::size_t c = 0; c < group_.size(); ++c) {
    sum.row(static_cast<Eigen::Index>(group_[c])) += rows.row(static_cast<Eigen::Index>(c));
    ++members[group_[c]];
  }
  for (std::size_t c = 0; c < group_.size(); ++c) {
    rows.row(static_cast<Eigen::Index>(c)) -=
        sum.row(static_cast<Eigen::Index>(group_[c])) / members[group_[c]];
  }
}

void CycleLevels::add(simulation::Covariate covariate, Eigen::MatrixXd terms) {
  centre(terms);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(terms.transpose() * terms);
  const double largest = solver.eigenvalues().maxCoeff();
  if (!(largest > 0)) return;
  Course course{covariate, Eigen::MatrixXd(terms.rows(), 0)};
  for (Eigen::Index k = 0; k < terms.cols(); ++k) {
    if (solver.eigenvalues()[k] <= kSingular * largest) continue;
    course.terms.conservativeResize(Eigen::NoChange, course.terms.cols() + 1);
    course.terms.rightCols(1) = terms * solver.eigenvectors().col(k) / std::sqrt(solver.eigenvalues()[k]);
  }
  const Eigen::Index spare = terms.rows() - static_cast<Eigen::Index>(groups_) - course.terms.cols();
  if (spare >= kMoreThanTerms) courses_.push_back(course);
}

void CycleLevels::plan(const Measured& measured) {
  const auto rows = static_cast<Eigen::Index>(cycles_.size());
  Eigen::MatrixXd since(rows, 2), clock(rows, 2), path_length(rows, 2), room(rows, 1);
  Eigen::MatrixXd mounts = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(measured.visits.size()));
  const double end = measured.time.back(), all = std::max(1.0, measured.path_length.back());
  for (Eigen::Index k = 0; k < rows; ++k) {
    const std::size_t c = cycles_[static_cast<std::size_t>(k)];
    const MeasuredCycle& cycle = measured.cycles[c];
    const auto number =
        static_cast<double>(c - measured.cycle[measured.visits[cycle.visit].first]);  // within the visit
    const double time = mean(measured.time, cycle) / end, gone = mean(measured.path_length, cycle) / all;
    since.row(k) << std::exp(-number), std::exp(-number / 3);
    clock.row(k) << time, time * time;
    path_length.row(k) << gone, std::sqrt(gone);
    room(k, 0) = measured.temperature.empty() ? 0 : mean(measured.temperature, cycle);
    mounts(k, static_cast<Eigen::Index>(cycle.visit)) = 1;
  }
  add(simulation::Covariate::kCycle, since);
  add(simulation::Covariate::kAccumulatedChange, path_length);
  add(simulation::Covariate::kClockTime, clock);
  if (rows > 0 && room.maxCoeff() - room.minCoeff() > kMoved) add(simulation::Covariate::kTemperature, room);
  if (measured.visits.size() > measured.classes.size()) add(simulation::Covariate::kMount, mounts);
}

Eigen::MatrixXd CycleLevels::drawn(const statistics::RandomStream& stream, std::uint64_t draw) const {
  Eigen::MatrixXd levels(levels_.rows(), 2);
  const auto number = static_cast<std::uint64_t>(levels.size());
  for (std::uint64_t k = 0; k < number; ++k)
    levels(static_cast<Eigen::Index>(k)) = stream.normal(draw * number + k);
  centre(levels);
  return levels;
}

double CycleLevels::statistic(const Eigen::MatrixXd& levels, const Course& course) const {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  double steps = 0;
  for (Eigen::Index k = 1; k < levels.rows(); ++k) {
    const auto now = static_cast<std::size_t>(k);
    if (visit_[now] != visit_[now - 1] || group_[now] != group_[now - 1]) continue;
    const Eigen::Vector2d step = levels.row(k) - levels.row(k - 1);
    scatter += step * step.transpose() / 2;
    ++steps;
  }
  const Eigen::MatrixXd explained = course.terms.transpose() * levels;  // [terms x 2]
  if (steps < 3) return 0;
  return steps * (scatter.inverse() * (explained.transpose() * explained)).trace();
}

double CycleLevels::explained(const Course& course) const {
  const Eigen::MatrixXd fitted = course.terms * (course.terms.transpose() * levels_);
  const auto cycles = static_cast<double>(std::max<Eigen::Index>(1, fitted.rows()));
  return (fitted.transpose() * fitted * gram_).trace() / cycles / std::max(1.0, samples_);
}

}  // namespace fsr::discrepancy
