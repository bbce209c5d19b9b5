#include "compensation/shape/learn_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/shape/coordinate_search.h"
#include "compensation/shape/rest_means.h"

namespace fsr::compensation {

namespace {

constexpr double kRidge = 1e-12;  // keeps covariances definite, relative to the variance
// A few surfaces do not tell lengths well: each is drawn to this share of the range, by a factor of e.
constexpr double kUnitsOfSpan = 7;

// Minus the logarithm of the likelihood of `number` samples under the covariance. `samples`: one a row, or
// condensed().
double minusLogLikelihood(const Eigen::MatrixXd& samples, std::size_t number, Eigen::MatrixXd covariance) {
  covariance.diagonal().array() += kRidge * covariance.trace() / double(covariance.rows());
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return std::numeric_limits<double>::max();
  const Eigen::MatrixXd lower = root.matrixL();
  const Eigen::MatrixXd white = root.matrixL().solve(samples.transpose());
  return double(number) * lower.diagonal().array().log().sum() + white.squaredNorm() / 2;
}

// At most as many rows as columns, with the same sum of products of the columns. The likelihood depends on
// the rows only through that sum, and the search evaluates it a few hundred times.
Eigen::MatrixXd condensed(const Eigen::MatrixXd& samples) {
  if (samples.rows() <= samples.cols()) return samples;
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(samples);
  return factors.matrixQR().topRows(samples.cols()).triangularView<Eigen::Upper>();
}

// Contrasts between mounts of one surface: independent, each with the variance of one mount (Helmert).
Eigen::MatrixXd contrastsOf(const std::vector<SurfaceRests>& surfaces, Eigen::Index taxels) {
  Eigen::Index rows = 0;
  const auto counts = [](const SurfaceRests& s) {
    return s.zero_share <= kMostZeros ? s.pressure.rows() - 1 : 0;
  };
  for (const SurfaceRests& surface : surfaces) rows += std::max<Eigen::Index>(0, counts(surface));
  Eigen::MatrixXd contrasts(rows, taxels);
  Eigen::Index row = 0;
  for (const SurfaceRests& surface : surfaces) {
    for (Eigen::Index m = 1; m <= counts(surface); ++m) {
      const Eigen::RowVectorXd before = surface.pressure.topRows(m).colwise().mean();
      contrasts.row(row++) =
          (surface.pressure.row(m) - before) * std::sqrt(double(m) / double(m + 1)) / surface.gain;
    }
  }
  return contrasts;
}

// Differences from the mean over the taxels, in directions over the sheet in which fields of mounts are
// independent.
struct BesideTheMean {
  Eigen::MatrixXd samples;    // [directions x surfaces] [Pa]
  Eigen::VectorXd variances;  // [directions], of one mount [Pa^2]
};

BesideTheMean besideTheMean(const RestMeans& means) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(means.beside);
  // The first direction is that of the mean, in which there is nothing beside it.
  const Eigen::Index size = means.beside.rows() - 1;
  const Eigen::MatrixXd beside = means.rest.colwise() - means.mean;
  return {solver.eigenvectors().rightCols(size).transpose() * beside.transpose(),
          solver.eigenvalues().tail(size).cwiseMax(0)};
}

}  // namespace

MountScatter learnScatter(const std::vector<SurfaceRests>& surfaces,
                          const std::vector<matrix::Position>& places) {
  MountScatter best;
  const auto taxels = static_cast<Eigen::Index>(places.size());
  const Eigen::MatrixXd contrasts = contrastsOf(surfaces, taxels);
  best.contrasts = static_cast<std::size_t>(contrasts.rows());
  if (best.contrasts == 0) return best;
  const Eigen::MatrixXd samples = condensed(contrasts);
  const double size = std::max(1.0, std::sqrt(contrasts.squaredNorm() / double(contrasts.size())));
  double widest = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double distance = std::hypot(places[i].x - places[0].x, places[i].y - places[0].y);
    widest = std::max(widest, distance);
    nearest = std::min(nearest, distance);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const FieldFamily family : {FieldFamily::kMatern, FieldFamily::kGaussian}) {
    MountScatter scatter = best;
    scatter.family = family;
    scatter.deviation = size;
    scatter.length = std::sqrt(nearest * widest);
    scatter.common = size / 2;
    scatter.white = size / 10;
    const auto cost = [&] {
      Eigen::MatrixXd covariance = fieldCovariance(scatter, places);
      covariance.diagonal().array() += scatter.white * scatter.white;
      // The common part is seen once a contrast only: it is held near the whole size.
      const double common = std::log(scatter.common / (size / 2));
      return minusLogLikelihood(samples, best.contrasts, std::move(covariance)) + common * common / 2;
    };
    const double found = search({{&scatter.deviation, size / 100, size * 30},
                                 {&scatter.length, nearest / 2, widest * 4},
                                 {&scatter.common, size / 100, size * 10},
                                 {&scatter.white, size / 1000, size * 3}},
                                cost);
    if (found < least) {
      least = found;
      best = scatter;
    }
  }
  return best;
}

ShapeLaw learnLaw(const ShapeModel& model) {
  ShapeModel trial = model;
  const RestMeans means(model);
  const BesideTheMean beside = besideTheMean(means);
  const double span = model.curvature.back() - model.curvature.front();
  const double size = std::max(1.0, std::sqrt((means.mean.array() - means.mean.mean()).square().mean()));
  const double own = std::max(1.0, std::sqrt(beside.samples.squaredNorm() / double(beside.samples.size())));
  ShapeLaw& law = trial.law;
  law = {size, 2, own / 4, 0.1, own / 2, span / kUnitsOfSpan, own / 10};

  const auto common_cost = [&] {
    Eigen::MatrixXd covariance = commonCovariances(trial);
    covariance.diagonal() += means.field_mean * means.mounted + means.cut;
    const double length = std::log(law.common_length / 2) / 0.7;
    return minusLogLikelihood(means.mean.transpose(), 1, std::move(covariance)) + length * length / 2;
  };
  search({{&law.common, size / 100, size * 30}, {&law.common_length, 0.2, 20}}, common_cost);

  const auto own_cost = [&] {
    Eigen::MatrixXd covariance = ownCovariances(trial, means.mean);
    covariance.diagonal().array() += law.own_white * law.own_white;
    const double length = std::log(law.own_length / (span / kUnitsOfSpan));
    double cost = length * length / 2;
    for (Eigen::Index d = 0; d < beside.samples.rows(); ++d) {
      Eigen::MatrixXd noisy = covariance;
      noisy.diagonal() += beside.variances(d) * means.mounted + means.cut;
      cost += minusLogLikelihood(beside.samples.row(d), 1, std::move(noisy));
    }
    return cost;
  };
  search({{&law.own, own / 1000, own * 10},
          {&law.own_length, span / 100, span * 4},
          {&law.own_share, 1e-4, 1},
          {&law.own_offset, own / 1000, own * 10},
          {&law.own_white, own / 1000, own}},
         own_cost);
  return law;
}

}  // namespace fsr::compensation
