#include "compensation/shape/rest_means.h"

#include <cmath>

namespace fsr::compensation {

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

}  // namespace fsr::compensation
