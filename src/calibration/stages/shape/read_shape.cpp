#include "calibration/stages/shape/read_shape.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr int kSteps = 80;                 // of the grid over the range of training
constexpr double kBeyond = 0.25;           // of the range: the grid on either side of it
constexpr double kInterval = 0.95;         // content of the interval
constexpr double kNormalOfReading = 1.96;  // half width of such an interval in deviations
constexpr double kLeastShare = 0.5;        // share of the taxels that must have a reading

}  // namespace

double scaledPressure(const ShapeModel& model, std::size_t taxel, double reading) {
  return model.scale[taxel] * reading / model.full_scale;
}

ShapeModel withoutSurface(ShapeModel model, std::size_t surface) {
  const auto at = static_cast<std::ptrdiff_t>(surface);
  const auto taxels = static_cast<std::ptrdiff_t>(model.used.size());
  model.surfaces.erase(model.surfaces.begin() + at);
  model.curvature.erase(model.curvature.begin() + at);
  model.mounts.erase(model.mounts.begin() + at);
  model.gain.erase(model.gain.begin() + at);
  model.zero_share.erase(model.zero_share.begin() + at);
  model.rest.erase(model.rest.begin() + at * taxels, model.rest.begin() + (at + 1) * taxels);
  model.error_between.assign(model.curvature.size() - 1, std::numeric_limits<double>::quiet_NaN());
  return model;
}

ShapeReader::ShapeReader(const ShapeModel& model) : model_(model), law_(model) {
  const double low = model.curvature.front(), span = model.curvature.back() - low;
  const int beyond = static_cast<int>(kBeyond * kSteps);
  for (int step = -beyond; step <= kSteps + beyond; ++step) grid_.push_back(low + span * step / kSteps);
  grid_.insert(grid_.end(), model.curvature.begin(), model.curvature.end());
  std::sort(grid_.begin(), grid_.end());
  const auto near = [&](double a, double b) { return b - a < 1e-3 * span / kSteps; };
  grid_.erase(std::unique(grid_.begin(), grid_.end(), near), grid_.end());
}

ShapeReader::Sample ShapeReader::sampleOf(const RestReading& rest) const {
  if (rest.reading.size() != model_.used.size()) {
    throw settings::InputError("the sheet has " + std::to_string(rest.reading.size()) +
                               " taxels, but its model of the shape has " +
                               std::to_string(model_.used.size()));
  }
  const std::vector<std::size_t>& taxels = law_.means().taxels;
  Sample sample;
  for (std::size_t i = 0; i < taxels.size(); ++i) {
    if (!std::isnan(rest.reading[taxels[i]])) sample.at.push_back(static_cast<Eigen::Index>(i));
  }
  if (double(sample.at.size()) < kLeastShare * double(taxels.size())) {
    throw settings::InputError("only " + std::to_string(sample.at.size()) + " of " +
                               std::to_string(taxels.size()) +
                               " taxels have a reading, too few to tell how the sheet lies");
  }
  const auto size = static_cast<Eigen::Index>(sample.at.size());
  sample.pressure.resize(size);
  sample.further_variance.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::size_t taxel = taxels[std::size_t(sample.at[std::size_t(i)])];
    sample.pressure(i) = scaledPressure(model_, taxel, rest.reading[taxel]);
    sample.further_variance(i) = rest.zero[taxel] != 0 ? law_.means().mount_variance : 0.0;
  }
  return sample;
}

RestLikelihood ShapeReader::likelihood(const Sample& sample, const Eigen::VectorXd& curvature) const {
  const RestPrediction prediction = law_.predict(curvature);
  Eigen::MatrixXd covariance = prediction.covariance(sample.at, sample.at);
  covariance.diagonal() += sample.further_variance;
  const Eigen::VectorXd difference = sample.pressure - prediction.mean(sample.at);
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::MatrixXd lower = root.matrixL();
  const double size = double(difference.size()), freedom = law_.means().freedom;
  RestLikelihood result;
  result.distance = root.matrixL().solve(difference).squaredNorm();
  result.logarithm =
      -lower.diagonal().array().log().sum() - (freedom + size) / 2 * std::log1p(result.distance / freedom);
  if (root.info() == Eigen::Success && std::isfinite(result.logarithm)) return result;
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

RestLikelihood ShapeReader::likelihood(const Sample& sample, double curvature) const {
  const auto size = static_cast<Eigen::Index>(law_.means().taxels.size());
  return likelihood(sample, Eigen::VectorXd::Constant(size, curvature));
}

ShapeEstimate ShapeReader::estimate(const RestReading& rest) const {
  const Sample sample = sampleOf(rest);
  std::vector<RestLikelihood> found;
  std::size_t best = 0;
  for (const double curvature : grid_) {
    found.push_back(likelihood(sample, curvature));
    if (found.back().logarithm > found[best].logarithm) best = found.size() - 1;
  }
  if (!std::isfinite(found[best].logarithm))
    throw settings::InputError("its model of the shape has no finite likelihood; train again");
  double least = found.front().distance, whole = 0, first = 0, second = 0;
  std::vector<double> weights;
  for (std::size_t g = 0; g < grid_.size(); ++g) {
    least = std::min(least, found[g].distance);
    const double low = grid_[g == 0 ? 0 : g - 1], high = grid_[std::min(g + 1, grid_.size() - 1)];
    weights.push_back((high - low) / 2 * std::exp(found[g].logarithm - found[best].logarithm));
    whole += weights.back();
    first += weights.back() * grid_[g];
    second += weights.back() * grid_[g] * grid_[g];
  }
  ShapeEstimate estimate;
  estimate.taxels = sample.at.size();
  estimate.curvature = first / whole;
  estimate.best = grid_[best];
  estimate.likelihood = found[best].logarithm;
  estimate.deviation = std::sqrt(std::max(0.0, second / whole - estimate.curvature * estimate.curvature));
  const auto quantile = [&](double share) {
    double sum = 0;
    std::size_t g = 0;
    while (g + 1 < grid_.size() && (sum += weights[g]) < share * whole) ++g;
    return g;
  };
  // The grid tells no more than its step.
  const std::size_t low = quantile((1 - kInterval) / 2), high = quantile((1 + kInterval) / 2);
  estimate.low = (grid_[low] + grid_[low == 0 ? 0 : low - 1]) / 2;
  estimate.high = (grid_[high] + grid_[std::min(high + 1, grid_.size() - 1)]) / 2;
  estimate.deviation = std::max(estimate.deviation, (estimate.high - estimate.low) / std::sqrt(12.0) / 2);
  estimate.fit = fit(least, estimate.taxels);
  addErrorBetween(estimate);
  return estimate;
}

// Between two surfaces the estimate cannot be better than it was on surfaces that it did not know.
void ShapeReader::addErrorBetween(ShapeEstimate& estimate) const {
  const std::vector<double>& knots = model_.curvature;
  estimate.beyond = estimate.high < knots.front() || estimate.low > knots.back();
  estimate.curvature = std::clamp(estimate.curvature, knots.front(), knots.back());
  const auto upper = std::upper_bound(knots.begin(), knots.end(), estimate.curvature);
  if (upper == knots.begin() || upper == knots.end()) return;
  const auto gap = static_cast<std::size_t>(upper - knots.begin()) - 1;
  const double width = knots[gap + 1] - knots[gap];
  const double away = std::min(estimate.curvature - knots[gap], knots[gap + 1] - estimate.curvature);
  estimate.between = away > width / kSteps;
  const double error = model_.error_between.at(gap) * std::min(1.0, 4 * away / width);
  if (!(error > estimate.deviation)) return;  // also NaN
  estimate.deviation = error;
  estimate.low = std::min(estimate.low, estimate.curvature - kNormalOfReading * error);
  estimate.high = std::max(estimate.high, estimate.curvature + kNormalOfReading * error);
}

double ShapeReader::fit(double distance, std::size_t taxels) const {
  const boost::math::fisher_f distribution(double(taxels), law_.means().freedom);
  return boost::math::cdf(boost::math::complement(distribution, distance / double(taxels)));
}

RestLikelihood ShapeReader::likelihood(const RestReading& rest, const std::vector<double>& curvature) const {
  const std::vector<std::size_t>& taxels = law_.means().taxels;
  Eigen::VectorXd declared(static_cast<Eigen::Index>(taxels.size()));
  for (std::size_t i = 0; i < taxels.size(); ++i)
    declared(Eigen::Index(i)) = curvature.size() == 1 ? curvature.front() : curvature.at(taxels[i]);
  return likelihood(sampleOf(rest), declared);
}

}  // namespace fsr::calibration
