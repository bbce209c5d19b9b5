#include "compensation/shape/bend_change.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "compensation/shape/coordinate_search.h"

namespace fsr::compensation {

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

}  // namespace fsr::compensation
