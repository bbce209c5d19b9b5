#include "calibration/stages/shape/rest_law.h"

#include <algorithm>
#include <cmath>

namespace fsr::calibration {

namespace {

constexpr double kWarp = 0.1;         // k0 of ShapeLaw [m]: bends of limbs and sockets have radii near 0.1 m
constexpr double kDrift = 1e5 * 1e5;  // variance of the unknown constant [Pa^2]

double warped(double curvature) {
  return std::copysign(std::log1p(std::abs(curvature) * kWarp), curvature);
}

double maternCorrelation(double distance, double length) {
  const double a = std::sqrt(3.0) * distance / length;
  return (1 + a) * std::exp(-a);
}

// Subtracts from rows and columns their means over the taxels.
Eigen::MatrixXd besideTheMean(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd rows = covariance.rowwise().mean();
  Eigen::MatrixXd beside = covariance.colwise() - rows;
  beside.rowwise() -= rows.transpose();
  return beside.array() + covariance.mean();
}

}  // namespace

Eigen::MatrixXd fieldCovariance(const MountScatter& scatter, const std::vector<matrix::Position>& places) {
  const auto size = static_cast<Eigen::Index>(places.size());
  const double variance = scatter.deviation * scatter.deviation, common = scatter.common * scatter.common;
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const matrix::Position &a = places[std::size_t(i)], &b = places[std::size_t(j)];
      const double distance = std::hypot(a.x - b.x, a.y - b.y), share = distance / scatter.length;
      const double correlation = scatter.family == FieldFamily::kMatern
                                     ? maternCorrelation(distance, scatter.length)
                                     : std::exp(-share * share / 2);
      covariance(i, j) = covariance(j, i) = variance * correlation + common;
    }
  }
  return covariance;
}

RestMeans::RestMeans(const ShapeModel& model) {
  std::vector<matrix::Position> places;
  for (std::size_t t = 0; t < model.used.size(); ++t) {
    if (model.used[t] == 0) continue;
    taxels.push_back(t);
    places.push_back(model.layout.position({t}));
  }
  const auto size = static_cast<Eigen::Index>(taxels.size());
  const auto surfaces = static_cast<Eigen::Index>(model.curvature.size());
  rest.resize(surfaces, size);
  for (Eigen::Index s = 0; s < surfaces; ++s) {
    for (Eigen::Index t = 0; t < size; ++t)
      rest(s, t) = model.rest[std::size_t(s) * model.used.size() + taxels[std::size_t(t)]];
  }
  mean = rest.rowwise().mean();
  field = fieldCovariance(model.scatter, places);
  field.diagonal().array() += model.scatter.white * model.scatter.white;
  freedom = double(model.scatter.contrasts) * std::pow(field.trace(), 2) / field.squaredNorm();
  Eigen::VectorXd history(size);
  for (Eigen::Index t = 0; t < size; ++t)
    history(t) = model.scatter.history * (model.history.empty() ? 1 : model.history[taxels[std::size_t(t)]]);
  field += history * history.transpose();
  beside = besideTheMean(field);
  field_mean = field.mean();
  mount_variance = field.trace() / double(size);
  mounted.resize(surfaces);
  cut.resize(surfaces);
  for (Eigen::Index s = 0; s < surfaces; ++s) {
    const auto c = static_cast<std::size_t>(s);
    mounted(s) = model.gain[c] * model.gain[c] / model.mounts[c];
    cut(s) = mount_variance * model.zero_share[c] / model.mounts[c];
  }
}

double commonCovariance(const ShapeLaw& law, double k, double l) {
  return law.common * law.common * maternCorrelation(std::abs(warped(k) - warped(l)), law.common_length) +
         kDrift;
}

double ownCovariance(const ShapeLaw& law, double k, double l, double mean_k, double mean_l) {
  return law.own_offset * law.own_offset + law.own_share * law.own_share * mean_k * mean_l +
         law.own * law.own * maternCorrelation(std::abs(k - l), law.own_length);
}

Eigen::MatrixXd commonCovariances(const ShapeModel& model) {
  const auto size = static_cast<Eigen::Index>(model.curvature.size());
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index s = 0; s < size; ++s) {
    for (Eigen::Index u = 0; u < size; ++u)
      covariance(s, u) =
          commonCovariance(model.law, model.curvature[std::size_t(s)], model.curvature[std::size_t(u)]);
  }
  return covariance;
}

Eigen::MatrixXd ownCovariances(const ShapeModel& model, const Eigen::VectorXd& mean) {
  Eigen::MatrixXd covariance(mean.size(), mean.size());
  for (Eigen::Index s = 0; s < mean.size(); ++s) {
    for (Eigen::Index u = 0; u < mean.size(); ++u)
      covariance(s, u) = ownCovariance(model.law, model.curvature[std::size_t(s)],
                                       model.curvature[std::size_t(u)], mean(s), mean(u));
  }
  return covariance;
}

namespace {

// Sensitivity of all taxels alike, which changes by 0.3 % a kelvin: ten kelvin.
constexpr double kSensitivity = 0.03;

// Linear between the knots, constant beyond them.
double between(const std::vector<double>& knots, const std::vector<double>& values, double at) {
  const auto upper = std::upper_bound(knots.begin(), knots.end(), at);
  if (upper == knots.begin()) return values.front();
  if (upper == knots.end()) return values.back();
  const auto k = static_cast<std::size_t>(upper - knots.begin());
  const double share = (at - knots[k - 1]) / (knots[k] - knots[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

}  // namespace

RestLaw::RestLaw(const ShapeModel& model)
    : model_(model),
      means_(model),
      common_(commonCovariances(model)),
      own_(ownCovariances(model, means_.mean)) {
  Eigen::MatrixXd common = common_, own = own_;
  common.diagonal() += means_.field_mean * means_.mounted + means_.cut;
  own.diagonal() += means_.beside.trace() / double(means_.taxels.size()) * means_.mounted + means_.cut;
  own.diagonal().array() += model.law.own_white * model.law.own_white;
  common_solver_.compute(common);
  own_solver_.compute(own);
  const double share = model.law.own_share * model.law.own_share;
  const Eigen::MatrixXd beside = means_.rest.colwise() - means_.mean;
  shares_ = (share * beside.transpose() * own_solver_.solve(means_.mean)).array() + 1;
}

RestLaw::Weights RestLaw::weightsAt(double curvature) const {
  Weights w;
  const auto surfaces = means_.mean.size();
  w.common_covariance.resize(surfaces);
  for (Eigen::Index s = 0; s < surfaces; ++s)
    w.common_covariance(s) = commonCovariance(model_.law, curvature, model_.curvature[std::size_t(s)]);
  w.common = common_solver_.solve(w.common_covariance);
  w.mean = w.common.dot(means_.mean);
  Eigen::VectorXd own(surfaces);
  for (Eigen::Index s = 0; s < surfaces; ++s)
    own(s) = ownCovariance(model_.law, curvature, model_.curvature[std::size_t(s)], w.mean, means_.mean(s));
  w.own = own_solver_.solve(own);
  const double variance = ownCovariance(model_.law, curvature, curvature, w.mean, w.mean);
  w.own_variance = std::max(0.0, variance - 2 * w.own.dot(own) + w.own.dot(own_ * w.own));
  w.gain = between(model_.curvature, model_.gain, curvature);
  return w;
}

Eigen::MatrixXd RestLaw::errorOfMean(const Eigen::VectorXd& curvature, const Eigen::MatrixXd& weights,
                                     const Eigen::MatrixXd& covariance) const {
  const Eigen::Index size = curvature.size();
  Eigen::MatrixXd error(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j)
      error(i, j) = commonCovariance(model_.law, curvature(i), curvature(j));
  }
  const Eigen::MatrixXd cross = weights * covariance.transpose();
  error += weights * common_ * weights.transpose() - cross - cross.transpose();
  const Eigen::VectorXd noise = means_.field_mean * means_.mounted + means_.cut;
  return error + weights * noise.asDiagonal() * weights.transpose();
}

RestPrediction RestLaw::predict(const Eigen::VectorXd& curvature) const {
  const Eigen::Index size = curvature.size(), surfaces = means_.mean.size();
  Eigen::MatrixXd common(size, surfaces), own(size, surfaces), covariance(size, surfaces);
  Eigen::VectorXd gain(size), variance(size);
  RestPrediction prediction;
  prediction.mean.resize(size);
  Weights w;
  for (Eigen::Index t = 0; t < size; ++t) {
    if (t == 0 || curvature(t) != curvature(t - 1)) w = weightsAt(curvature(t));
    common.row(t) = w.common;
    own.row(t) = w.own;
    covariance.row(t) = w.common_covariance;
    gain(t) = w.gain;
    variance(t) = w.own_variance;
    prediction.mean(t) = w.mean + w.own.dot(means_.rest.col(t) - means_.mean);
  }
  // A new mount; the mounts behind the means; the law of the mean, which moves each taxel by its share;
  // another temperature.
  const Eigen::MatrixXd law = errorOfMean(curvature, common, covariance);
  prediction.covariance = means_.field.cwiseProduct(gain * gain.transpose()) +
                          means_.beside.cwiseProduct(own * means_.mounted.asDiagonal() * own.transpose()) +
                          law.cwiseProduct(shares_ * shares_.transpose()) +
                          kSensitivity * kSensitivity * prediction.mean * prediction.mean.transpose();
  const Eigen::MatrixXd squares = own.cwiseAbs2();
  const double white = model_.law.own_white * model_.law.own_white;
  prediction.covariance.diagonal() += variance + squares * means_.cut;
  prediction.covariance.diagonal().array() += white * (1 + squares.rowwise().sum().array());
  return prediction;
}

}  // namespace fsr::calibration
