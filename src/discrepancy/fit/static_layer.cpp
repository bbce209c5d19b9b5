#include "discrepancy/fit/static_layer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "discrepancy/fit/parameter_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastZ = 6;
constexpr std::size_t kPoints = 60;       // in each curve
constexpr double kSure = 2;               // standard errors; a smaller difference may be due to chance
constexpr double kFewSamples = 8;         // at one pressure; fewer give no estimate
constexpr double kCorrelatedSamples = 5;  // samples that count as one, because the noise is coloured

// Smooth functions of the position on the sheet: powers of x and y up to a degree, without the constant.
Eigen::MatrixXd smoothFields(const matrix::Layout& layout, const std::vector<std::size_t>& taxels) {
  const std::size_t degree = taxels.size() >= 40 ? 3 : taxels.size() >= 12 ? 2 : 1;
  const auto n = static_cast<Eigen::Index>(taxels.size());
  Eigen::MatrixXd fields(n, 0);
  const double half_x = std::max(1, layout.size.columns - 1) * layout.pitch_x / 2;
  const double half_y = std::max(1, layout.size.rows - 1) * layout.pitch_y / 2;
  for (std::size_t i = 0; i <= degree; ++i) {
    for (std::size_t j = 0; i + j <= degree; ++j) {
      if (i + j == 0) continue;
      fields.conservativeResize(Eigen::NoChange, fields.cols() + 1);
      for (Eigen::Index t = 0; t < n; ++t) {
        const matrix::Position at = layout.position({taxels[static_cast<std::size_t>(t)]});
        fields(t, fields.cols() - 1) =
            std::pow(at.x / half_x, static_cast<double>(i)) * std::pow(at.y / half_y, static_cast<double>(j));
      }
    }
  }
  fields.rowwise() -= fields.colwise().mean();
  return Eigen::MatrixXd(fields.householderQr().householderQ() * Eigen::MatrixXd::Identity(n, fields.cols()));
}

// Preload and gain of each taxel in one mount, relative to the surface's mean.
struct MountFields {
  Eigen::MatrixXd change;  // [taxels x 2], preload [Pa] and gain
  Eigen::Matrix2d gram;    // Gram matrix of slope and rise, summed over the samples
  double samples = 0;
  std::size_t curvature_class = 0;
};

MountFields fieldsOf(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                     std::size_t visit, const std::vector<std::size_t>& used, const Trace& explained,
                     const Eigen::MatrixXd& mask) {
  MountFields fields;
  const Visit& at = measured.visits[visit];
  fields.curvature_class = at.curvature_class;
  fields.gram.setZero();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(used.size()));
  std::vector<double> residual;
  for (std::size_t i = at.first; i < at.last; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    taxels.residuals(i, residual);
    const Eigen::Vector2d x(fit.slope()[k], fit.netCurve()[k]);
    fields.gram += x * x.transpose();
    for (std::size_t t = 0; t < used.size(); ++t) {
      double r = residual[used[t]];
      if (explained.size() > 0) {
        r -= mask(static_cast<Eigen::Index>(used[t]), static_cast<Eigen::Index>(at.curvature_class)) *
             explained[k];
      }
      right.col(static_cast<Eigen::Index>(t)) += x * r;
    }
    ++fields.samples;
  }
  fields.change = fields.gram.ldlt().solve(right).transpose();
  return fields;
}

double interpolate(const Eigen::VectorXd& values, double low, double step, double at) {
  const double place = (at - low) / step;
  const auto i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(place)), 0, values.size() - 2);
  const double share = place - static_cast<double>(i);
  return values[i] + share * (values[i + 1] - values[i]);
}

// Loads of a class of curvature to which its curve is fitted [Pa].
struct Covered {
  double low = INFINITY, high = -INFINITY;
};

std::vector<Covered> coveredBy(const Measured& measured, const StaticFit& fit) {
  std::vector<Covered> covered(measured.classes.size());
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (!fit.isFitted(i)) continue;
    Covered& of = covered[measured.classOf(i)];
    of.low = std::min(of.low, measured.loads()[i]);
    of.high = std::max(of.high, measured.loads()[i]);
  }
  return covered;
}

// Maps the reference onto a curve by gain and preload, over the pressures that both cover.
class Mapping {
 public:
  Mapping(const Eigen::VectorXd& curve, const Eigen::VectorXd& reference, double low, double step,
          double unloaded, const Covered& own, const Covered& other)
      : curve_(curve),
        reference_(reference),
        low_(low),
        step_(step),
        unloaded_(unloaded),
        own_(own),
        other_(other) {}

  // Curve less the mapped reference; 0 where one of them has no samples.
  Eigen::VectorXd misfit() const {
    Eigen::VectorXd best = Eigen::VectorXd::Zero(curve_.size());
    double least = INFINITY;
    const auto fitted = [this](const std::vector<double>& at) { return scaled(at); };
    for (const double preload : {-1.0, 0.0, 1.0}) {
      const std::vector<double> start = {0, preload};
      if (!scaled(start)) continue;
      LevenbergOptions options;
      options.steps = 30;
      const std::vector<double> at = levenberg(fitted, start, options);
      const double square = scaled(at)->squaredNorm();
      if (square < least) least = square, best = error(at).first;
    }
    return best;
  }

 private:
  // Error at each point, and the number of points that both cover. `at`: relative gain, and preload as a
  // share of a tenth of all pressures.
  std::pair<Eigen::VectorXd, double> error(const std::vector<double>& at) const {
    const double high = low_ + step_ * static_cast<double>(curve_.size() - 1);
    Eigen::VectorXd error = Eigen::VectorXd::Zero(curve_.size());
    double both = 0;
    for (Eigen::Index i = 0; i < curve_.size(); ++i) {
      const double pressure = low_ + step_ * static_cast<double>(i),
                   load = pressure + at[1] * (high - low_) / 10;
      if (pressure < own_.low || pressure > own_.high || load < other_.low || load > other_.high) continue;
      error[i] =
          curve_[i] - unloaded_ - (1 + at[0]) * (interpolate(reference_, low_, step_, load) - unloaded_);
      ++both;
    }
    return {error, both};
  }
  // The error per point. Nothing where less than half of the curve meets the reference.
  std::optional<Eigen::VectorXd> scaled(const std::vector<double>& at) const {
    const auto [left, both] = error(at);
    const double shared = std::min(own_.high, other_.high) - std::max(own_.low, other_.low);
    if (both * step_ < shared / 2 || both < 3) return std::nullopt;
    return Eigen::VectorXd(left / std::sqrt(both));
  }

  const Eigen::VectorXd& curve_;
  const Eigen::VectorXd& reference_;
  double low_, step_, unloaded_;
  Covered own_, other_;
};

// Variance of each class's curve at each pressure, estimated from the residuals there; infinite where there
// are too few samples.
Eigen::MatrixXd chanceOf(const Measured& measured, const StaticFit& fit, const Trace& common, double low,
                         double step) {
  const auto classes = static_cast<Eigen::Index>(measured.classes.size());
  const auto points = static_cast<Eigen::Index>(kPoints);
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(points, classes), number = squares;
  const Trace left = fit.residual(common);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto k = static_cast<Eigen::Index>(std::lround((measured.loads()[i] - low) / step));
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    if (k < 0 || k >= points || !fit.isFitted(i)) continue;
    squares(k, c) += std::pow(left[static_cast<Eigen::Index>(i)], 2);
    number(k, c) += 1;
  }
  Eigen::MatrixXd chance(points, classes);
  for (Eigen::Index c = 0; c < classes; ++c) {
    for (Eigen::Index k = 0; k < points; ++k) {
      const double n = number(k, c);
      chance(k, c) = n < kFewSamples ? INFINITY : kCorrelatedSamples * squares(k, c) / (n * n);
    }
  }
  return chance;
}

// Rms of the misfit divided by the slope of the curve at that pressure [Pa]. Where a curve is nearly flat, a
// reading tells nothing of the pressure.
double atMap(const Eigen::MatrixXd& misfit, const Eigen::MatrixXd& curves, double step) {
  constexpr double kLeastSlope = 0.05;  // of the mean slope
  const Eigen::Index last = curves.rows() - 1;
  double square = 0, number = 0;
  for (Eigen::Index c = 0; c < curves.cols(); ++c) {
    const double mean = (curves(last, c) - curves(0, c)) / (static_cast<double>(last) * step);
    for (Eigen::Index k = 0; k <= last; ++k) {
      const Eigen::Index a = std::max<Eigen::Index>(0, k - 1), b = std::min(last, k + 1);
      const double slope = (curves(b, c) - curves(a, c)) / (static_cast<double>(b - a) * step);
      if (slope < kLeastSlope * mean || !(slope > 0)) continue;
      square += std::pow(misfit(k, c) / slope, 2);
      ++number;
    }
  }
  return number > 0 ? std::sqrt(square / number) : 0;
}

}  // namespace

Repositioning findRepositioning(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                                const Trace& explained, const Eigen::MatrixXd& mask) {
  Repositioning found;
  std::vector<std::size_t> used;
  for (std::size_t t = 0; t < measured.taxels(); ++t) {
    if (measured.used[t]) used.push_back(t);
  }
  const std::vector<std::size_t> mounts_of = measured.mounts();
  if (used.size() < 4 || *std::max_element(mounts_of.begin(), mounts_of.end()) < 2) return found;
  const Eigen::MatrixXd smooth = smoothFields(measured.layout, used);
  const auto n = static_cast<double>(used.size()), terms = static_cast<double>(smooth.cols());
  double inside = 0, outside = 0, samples = 0, offsets = 0, gains = 0, mounts = 0;
  std::map<std::size_t, double> by_class;
  for (std::size_t v = 0; v < measured.visits.size(); ++v) {
    if (mounts_of[measured.visits[v].curvature_class] < 2) continue;
    MountFields fields = fieldsOf(measured, fit, taxels, v, used, explained, mask);
    fields.change.rowwise() -= fields.change.colwise().mean().eval();
    const Eigen::MatrixXd smoothed = smooth * (smooth.transpose() * fields.change);
    const double all = (fields.change * fields.gram * fields.change.transpose()).trace();
    const double explains = (smoothed * fields.gram * smoothed.transpose()).trace();
    inside += explains;
    outside += all - explains;
    samples += fields.samples;
    by_class[fields.curvature_class] += explains;
    offsets += smoothed.col(0).squaredNorm() / n;
    gains += smoothed.col(1).squaredNorm() / n;
    ++mounts;
  }
  const double chance = outside / (n - 1 - terms) * terms;  // what the smooth fields would explain by chance
  const Spread nothing = spreadOf(measured, taxels, Trace::Zero(fit.netCurve().size()));
  found.share = nothing.square > 0 ? (inside - chance) / (samples * n) / nothing.square : 0;
  found.z = (inside - chance) / std::max(1e-300, chance * std::sqrt(1 / (terms * mounts)));
  found.offset = std::sqrt(offsets / mounts);
  found.gain = std::sqrt(gains / mounts);
  found.found = found.share >= thresholds::kLeastShareOfError && found.z >= kLeastZ;
  double most = 0;
  for (const auto& [c, square] : by_class) most = std::max(most, square);
  for (const auto& [c, square] : by_class) {
    if (square >= thresholds::kShows * thresholds::kShows * most)
      found.where.conditions.push_back(measured.classes[c].surface);
  }
  if (found.where.conditions.size() == measured.classes.size()) found.where.conditions.clear();
  found.where.pressure = {0, *std::max_element(measured.pressure.begin(), measured.pressure.end())};
  return found;
}

StaticMisfit findStaticMisfit(const Measured& measured, const StaticFit& fit, const Trace& common,
                              double square) {
  StaticMisfit result;
  if (measured.classes.size() < 2) return result;
  const std::vector<double>& load = measured.loads();
  const auto [least, most] = std::minmax_element(load.begin(), load.end());
  const double low = std::max(0.0, *least), step = (*most - low) / (kPoints - 1);
  std::vector<std::size_t> sample_of(measured.classes.size(), measured.samples());
  for (std::size_t i = 0; i < measured.samples(); ++i) sample_of[measured.classOf(i)] = i;
  Eigen::MatrixXd curves(static_cast<Eigen::Index>(kPoints),
                         static_cast<Eigen::Index>(measured.classes.size()));
  for (Eigen::Index c = 0; c < curves.cols(); ++c) {
    for (Eigen::Index k = 0; k < curves.rows(); ++k) {
      curves(k, c) = fit.curveAt(sample_of[static_cast<std::size_t>(c)], low + step * static_cast<double>(k));
    }
  }
  const Eigen::MatrixXd chance = chanceOf(measured, fit, common, low, step);
  const std::vector<Covered> covered = coveredBy(measured, fit);
  Eigen::MatrixXd misfit = Eigen::MatrixXd::Zero(curves.rows(), curves.cols());
  for (Eigen::Index c = 1; c < curves.cols(); ++c) {
    const Eigen::VectorXd curve = curves.col(c), reference = curves.col(0);
    misfit.col(c) = Mapping(curve, reference, low, step, fit.unloaded(), covered[static_cast<std::size_t>(c)],
                            covered.front())
                        .misfit();
    for (Eigen::Index k = 0; k < curves.rows(); ++k) {
      const double by_chance = kSure * std::sqrt(chance(k, c) + chance(k, 0));
      misfit(k, c) = std::copysign(std::max(0.0, std::abs(misfit(k, c)) - by_chance), misfit(k, c));
    }
  }
  const double mean = misfit.squaredNorm() / static_cast<double>(misfit.size());
  result.rms = std::sqrt(mean);
  result.share = square > 0 ? mean / square : 0;
  result.at_map = atMap(misfit, curves, step);
  // One function of the reading, as a sum of hats over the readings.
  constexpr Eigen::Index kHats = 8;
  Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(misfit.size(), kHats);
  const double highest = curves.maxCoeff();
  for (Eigen::Index i = 0; i < misfit.size(); ++i) {
    const double place = curves(i % curves.rows(), i / curves.rows()) / highest * (kHats - 1);
    for (Eigen::Index h = 0; h < kHats; ++h)
      hats(i, h) = std::max(0.0, 1 - std::abs(place - static_cast<double>(h)));
  }
  const Eigen::Map<const Eigen::VectorXd> flat(misfit.data(), misfit.size());
  const Eigen::VectorXd fitted = hats * hats.colPivHouseholderQr().solve(flat);
  result.by_code = flat.squaredNorm() > 0 ? 1 - (flat - fitted).squaredNorm() / flat.squaredNorm() : 0;
  const Eigen::VectorXd by_pressure = misfit.rowwise().norm();
  result.pressure = {INFINITY, 0};
  for (Eigen::Index k = 0; k < by_pressure.size(); ++k) {
    if (by_pressure[k] < thresholds::kPressureShows * by_pressure.maxCoeff()) continue;
    result.pressure.low = std::min(result.pressure.low, low + step * static_cast<double>(k));
    result.pressure.high = std::max(result.pressure.high, low + step * static_cast<double>(k));
  }
  const Eigen::VectorXd by_class = misfit.colwise().norm();
  for (Eigen::Index c = 0; c < by_class.size(); ++c) {
    if (by_class[c] >= thresholds::kShows * by_class.maxCoeff())
      result.conditions.push_back(measured.classes[static_cast<std::size_t>(c)].surface);
  }
  return result;
}

}  // namespace fsr::discrepancy
