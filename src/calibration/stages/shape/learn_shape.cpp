#include "calibration/stages/shape/learn_shape.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

#include "calibration/stages/shape/rest_law.h"

namespace fsr::calibration {

namespace {

constexpr int kRounds = 6;           // over all parameters
constexpr int kBits = 14;            // precision along each: a ten-thousandth of the range
constexpr double kLeastGain = 1e-3;  // of a round

}  // namespace

double search(const std::vector<Searched>& parameters, const std::function<double()>& cost) {
  double best = cost();
  for (int round = 0; round < kRounds; ++round) {
    const double before = best;
    for (const Searched& parameter : parameters) {
      const bool logarithmic = parameter.scale == SearchScale::kLogarithmic;
      const auto scaled = [&](double value) { return logarithmic ? std::log(value) : value; };
      const double kept = *parameter.value;
      const auto valueAt = [&](double place) { return logarithmic ? std::exp(place) : place; };
      const auto along = [&](double place) {
        *parameter.value = valueAt(place);
        return cost();
      };
      const auto [at, least] =
          boost::math::tools::brent_find_minima(along, scaled(parameter.low), scaled(parameter.high), kBits);
      *parameter.value = least < best ? valueAt(at) : kept;
      best = std::min(best, least);
    }
    if (before - best < kLeastGain) break;
  }
  return best;
}

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

ShapeLaw learnShapeLaw(const ShapeModel& model) {
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

namespace {

constexpr int kCentres = 8;     // steps of the start over the training
constexpr int kChanges = 5;     // and of each change on either side of none
constexpr double kStep = 0.02;  // of the differences for the deviations, share of the range
constexpr double kReach = 0.2;  // of the climb on either side of the start, share of the range
constexpr double kPrior = 10;  // deviation where the readings tell nothing, in ranges: keeps variances finite
constexpr double kNormalOfChange = 1.96;  // half width of a 95 % interval in deviations

/// The likelihood of a bend that changes linearly.
class LinearBend {
 public:
  LinearBend(const ShapeReader& reader, const ShapeModel& model, const RestReading& rest)
      : reader_(reader), rest_(rest), x_(model.used.size()), y_(model.used.size()) {
    for (std::size_t t = 0; t < model.used.size(); ++t) {
      const matrix::Position place = model.layout.position({t});
      x_[t] = place.x;
      y_[t] = place.y;
    }
    centre(x_);
    centre(y_);
  }

  /// [taxels], within the curvatures that can be predicted. `bend`: in the middle, change along x, along y.
  std::vector<double> curvature(const Eigen::Vector3d& bend) const {
    std::vector<double> result(x_.size());
    for (std::size_t t = 0; t < result.size(); ++t)
      result[t] = std::clamp(bend(0) + bend(1) * x_[t] + bend(2) * y_[t], reader_.grid().front(),
                             reader_.grid().back());
    return result;
  }

  double logarithm(const Eigen::Vector3d& bend) const { return likelihood(bend).logarithm; }
  RestLikelihood likelihood(const Eigen::Vector3d& bend) const {
    return reader_.likelihood(rest_, curvature(bend));
  }

 private:
  // From -1/2 on the first to 1/2 on the last; 0 where all are in one place.
  static void centre(std::vector<double>& places) {
    const auto [low, high] = std::minmax_element(places.begin(), places.end());
    const double middle = (*low + *high) / 2, extent = *high - *low;
    for (double& place : places) place = extent > 0 ? (place - middle) / extent : 0;
  }

  const ShapeReader& reader_;
  const RestReading& rest_;
  std::vector<double> x_, y_;  // [taxels], shares of the sheet
};

// The most likely of a grid over the middle and both changes: the likelihood has many maxima where taxels
// differ.
Eigen::Vector3d bestStart(const LinearBend& bend, const ShapeModel& model, double centre) {
  const double low = model.curvature.front(), span = model.curvature.back() - low;
  Eigen::Vector3d best(centre, 0, 0);
  double highest = bend.logarithm(best);
  for (int c = 0; c <= kCentres; ++c) {
    for (int x = -kChanges; x <= kChanges; ++x) {
      for (int y = -kChanges; y <= kChanges; ++y) {
        const Eigen::Vector3d start(low + span * c / kCentres, span * x / kChanges, span * y / kChanges);
        const double own = bend.logarithm(start);
        if (own <= highest) continue;
        highest = own;
        best = start;
      }
    }
  }
  return best;
}

// Second derivatives of the logarithm of the likelihood, by central differences.
Eigen::Matrix3d secondDerivatives(const LinearBend& bend, const Eigen::Vector3d& at, double step) {
  Eigen::Matrix3d derivatives;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Eigen::Vector3d a = step * Eigen::Vector3d::Unit(i), b = step * Eigen::Vector3d::Unit(j);
      derivatives(i, j) = derivatives(j, i) = (bend.logarithm(at + a + b) - bend.logarithm(at + a - b) -
                                               bend.logarithm(at - a + b) + bend.logarithm(at - a - b)) /
                                              (4 * step * step);
    }
  }
  return derivatives;
}

// Variance of the error to expect on a surface that the model does not know [1/m^2].
double errorAt(const ShapeModel& model, double curvature) {
  const std::vector<double>& knots = model.curvature;
  const auto upper = std::upper_bound(knots.begin() + 1, knots.end() - 1, curvature);
  const double error = model.error_between.at(static_cast<std::size_t>(upper - knots.begin()) - 1);
  return std::isnan(error) ? 0.0 : error * error;
}

// `variance`: of the likelihood. Between surfaces of training neither end can be told better than such
// surfaces were.
BendChange changeOf(const ShapeModel& model, double centre, double change, double variance) {
  const double ends = errorAt(model, centre - change / 2) + errorAt(model, centre + change / 2);
  const double deviation =
      variance > 0 ? std::sqrt(variance + ends) : std::numeric_limits<double>::infinity();
  return {change, deviation, change - kNormalOfChange * deviation, change + kNormalOfChange * deviation};
}

// The logarithm of the likelihood there; moves `best` to the maximum nearby.
double climb(const LinearBend& bend, const ShapeReader& reader, double span, Eigen::Vector3d& best) {
  const double reach = kReach * span;
  const auto around = [&](int i, double low, double high) {
    return Searched{&best(i), std::max(low, best(i) - reach), std::min(high, best(i) + reach),
                    SearchScale::kLinear};
  };
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return -search({around(0, reader.grid().front(), reader.grid().back()), around(1, -kAny, kAny),
                  around(2, -kAny, kAny)},
                 [&] { return -bend.logarithm(best); });
}

}  // namespace

ChangingBend tellBendChange(const ShapeReader& reader, const ShapeModel& model, const RestReading& rest,
                            const ShapeEstimate& constant) {
  const LinearBend bend(reader, model, rest);
  const double span = model.curvature.back() - model.curvature.front();
  Eigen::Vector3d best = bestStart(bend, model, constant.best);
  ChangingBend result;
  result.likelihood = climb(bend, reader, span, best);
  result.centre = best(0);
  result.curvature = bend.curvature(best);
  const boost::math::chi_squared ratio(2);
  result.probability = boost::math::cdf(
      boost::math::complement(ratio, std::max(0.0, 2 * (result.likelihood - constant.likelihood))));
  result.fit = reader.fit(bend.likelihood(best).distance, constant.taxels);
  Eigen::Matrix3d precision = -secondDerivatives(bend, best, kStep * span);
  precision.diagonal().array() += 1 / std::pow(kPrior * span, 2);
  const Eigen::Matrix3d covariance = precision.inverse();
  result.along_x = changeOf(model, best(0), best(1), covariance(1, 1));
  result.along_y = changeOf(model, best(0), best(2), covariance(2, 2));
  return result;
}

}  // namespace fsr::calibration
