#include "discrepancy/fit/static_misfit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "discrepancy/fit/parameter_fit.h"
#include "simulation/effects/effect_library.h"
#include "statistics/signed_least_squares.h"

namespace fsr::discrepancy {

namespace {

using Index = Eigen::Index;

constexpr Index kPoints = 60;             // in each curve
constexpr double kSure = 2;               // standard errors; a smaller difference may be due to chance
constexpr double kFewSamples = 8;         // at one pressure; fewer give no estimate
constexpr double kCorrelatedSamples = 5;  // samples that count as one, because the noise is coloured
constexpr Index kLimitKnots = 16;         // of a limit, above half of the highest reading
constexpr int kPasses = 4;                // of a limit's fit, each with the slope of the last one

double interpolate(const Eigen::VectorXd& values, double low, double step, double at) {
  const double place = (at - low) / step;
  const auto i = std::clamp<Index>(static_cast<Index>(std::floor(place)), 0, values.size() - 2);
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

// The mean curves of the classes of curvature at equal loads, and the loads that each of them covers.
struct ClassCurves {
  Eigen::MatrixXd reading;  // above that of no load [points x classes], share of full scale
  std::vector<Covered> covered;
  double low = 0, step = 0;  // loads [Pa]

  double load(Index point) const { return low + step * static_cast<double>(point); }
  double span() const { return load(kPoints - 1) - low; }
};

// What the read-out does to high readings: without it, y would be x = y + sum of v_j max(0, y - k_j). With
// v_j >= 0 this is any concave limit.
struct Limit {
  Eigen::VectorXd knots, weights;

  Eigen::RowVectorXd over(double reading) const {
    return (reading - knots.array()).max(0.0).matrix().transpose();
  }
  double without(double reading) const { return reading + over(reading).dot(weights); }
  double slope(double reading) const { return 1 + (reading > knots.array()).select(weights, 0.0).sum(); }
};

Limit noLimit(double highest) {
  Limit limit;
  limit.knots = Eigen::VectorXd::LinSpaced(kLimitKnots + 1, 0.5, 1).head(kLimitKnots) * highest;
  limit.weights.setZero(kLimitKnots);
  return limit;
}

// Maps the curve of the first class onto those of others by gain and preload, beside a limit of all curves or
// none. Coordinates, of each class: relative gain, and preload as a share of a tenth of all loads.
class Mapping {
 public:
  Mapping(const ClassCurves& curves, std::vector<Index> classes, bool limited)
      : curves_(curves),
        classes_(std::move(classes)),
        limited_(limited),
        none_(noLimit(curves.reading.maxCoeff())) {}

  // Error per point, in readings. Nothing where less than half of a curve meets the first one.
  std::optional<Eigen::VectorXd> scaledError(const std::vector<double>& at) const {
    const auto all = rows(at);
    if (!all) return std::nullopt;
    return Eigen::VectorXd(all->scale.cwiseProduct(errorOf(*all, limitOf(*all))));
  }
  Limit limit(const std::vector<double>& at) const { return limitOf(*rows(at)); }
  // Curves less the mapped ones [points x classes]; 0 where one of them has no samples.
  void putMisfit(const std::vector<double>& at, Eigen::MatrixXd& misfit) const {
    const auto all = rows(at);
    const Eigen::VectorXd error = errorOf(*all, limitOf(*all));
    for (std::size_t m = 0; m < classes_.size(); ++m)
      misfit.col(classes_[m]) = error.segment(kPoints * static_cast<Index>(m), kPoints);
  }

 private:
  // One row for each point of each class.
  struct Rows {
    Eigen::VectorXd own;    // reading of the class
    Eigen::VectorXd plain;  // less the mapped one, without a limit
    Eigen::MatrixXd limit;  // what the weights of a limit add to this difference
    Eigen::VectorXd scale;
  };
  std::optional<Rows> rows(const std::vector<double>& at) const;
  Limit limitOf(const Rows& rows) const;
  static Eigen::VectorXd errorOf(const Rows& rows, const Limit& limit) {
    Eigen::VectorXd error = rows.plain + rows.limit * limit.weights;
    for (Index i = 0; i < error.size(); ++i) error[i] /= limit.slope(rows.own[i]);
    return error;
  }

  const ClassCurves& curves_;
  std::vector<Index> classes_;
  bool limited_;
  Limit none_;
};

std::optional<Mapping::Rows> Mapping::rows(const std::vector<double>& at) const {
  const Index size = kPoints * static_cast<Index>(classes_.size());
  Rows rows{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size),
            Eigen::MatrixXd::Zero(size, kLimitKnots), Eigen::VectorXd::Zero(size)};
  const Eigen::VectorXd first = curves_.reading.col(0);
  const Covered& of_first = curves_.covered.front();
  for (std::size_t m = 0; m < classes_.size(); ++m) {
    const Covered& own = curves_.covered[static_cast<std::size_t>(classes_[m])];
    const double gain = 1 + at[2 * m], preload = at[2 * m + 1] * curves_.span() / 10;
    const Index begin = kPoints * static_cast<Index>(m);
    double both = 0;
    for (Index i = 0; i < kPoints; ++i) {
      const double here = curves_.load(i), there = here + preload;
      if (here < own.low || here > own.high || there < of_first.low || there > of_first.high) continue;
      const double reading = curves_.reading(i, classes_[m]);
      const double other = interpolate(first, curves_.low, curves_.step, there);
      rows.own[begin + i] = reading;
      rows.plain[begin + i] = reading - gain * other;
      rows.limit.row(begin + i) = none_.over(reading) - gain * none_.over(other);
      ++both;
    }
    const double shared = std::min(own.high, of_first.high) - std::max(own.low, of_first.low);
    if (both * curves_.step < shared / 2 || both < 3) return std::nullopt;
    rows.scale.segment(begin, kPoints).setConstant(1 / std::sqrt(both));
  }
  return rows;
}

Limit Mapping::limitOf(const Rows& rows) const {
  Limit limit = none_;
  for (int pass = 0; limited_ && pass < kPasses; ++pass) {
    Eigen::VectorXd weight = rows.scale;
    for (Index i = 0; i < weight.size(); ++i) weight[i] /= limit.slope(rows.own[i]);
    const Eigen::MatrixXd weighted = weight.asDiagonal() * rows.limit;
    Eigen::MatrixXd gram = weighted.transpose() * weighted;
    gram.diagonal().array() += 1e-6 * gram.trace() + 1e-300;
    limit.weights = statistics::solveSigned(gram, -weighted.transpose() * weight.cwiseProduct(rows.plain),
                                            std::vector<bool>(static_cast<std::size_t>(kLimitKnots), false));
  }
  return limit;
}

// The best of several starts; empty where no start is permitted.
std::vector<double> bestFrom(const Residuals& error, const std::vector<std::vector<double>>& starts) {
  LevenbergOptions options;
  options.steps = 60;
  std::vector<double> best;
  double least = INFINITY;
  for (const std::vector<double>& start : starts) {
    if (!error(start)) continue;
    const std::vector<double> at = levenberg(error, start, options);
    const double square = error(at)->squaredNorm();
    if (square < least) least = square, best = at;
  }
  return best;
}

Residuals errorOf(const Mapping& mapping) {
  return [&mapping](const std::vector<double>& at) { return mapping.scaledError(at); };
}

// Variance of each class's curve at each pressure, estimated from the residuals there; infinite where there
// are too few samples.
Eigen::MatrixXd chanceOf(const Measured& measured, const StaticFit& fit, const Trace& common, double low,
                         double step) {
  const auto classes = static_cast<Index>(measured.classes.size());
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(kPoints, classes), number = squares;
  const Trace left = fit.residual(common);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto k = static_cast<Index>(std::lround((measured.loads()[i] - low) / step));
    const auto c = static_cast<Index>(measured.classOf(i));
    if (k < 0 || k >= kPoints || !fit.isFitted(i)) continue;
    squares(k, c) += std::pow(left[static_cast<Index>(i)], 2);
    number(k, c) += 1;
  }
  Eigen::MatrixXd chance(kPoints, classes);
  for (Index c = 0; c < classes; ++c) {
    for (Index k = 0; k < kPoints; ++k) {
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
  const Index last = curves.rows() - 1;
  double square = 0, number = 0;
  for (Index c = 0; c < curves.cols(); ++c) {
    const double mean = (curves(last, c) - curves(0, c)) / (static_cast<double>(last) * step);
    for (Index k = 0; k <= last; ++k) {
      const Index a = std::max<Index>(0, k - 1), b = std::min(last, k + 1);
      const double slope = (curves(b, c) - curves(a, c)) / (static_cast<double>(b - a) * step);
      if (slope < kLeastSlope * mean || !(slope > 0)) continue;
      square += std::pow(misfit(k, c) / slope, 2);
      ++number;
    }
  }
  return number > 0 ? std::sqrt(square / number) : 0;
}

// The curves of all classes that meet the first one, with the gains and preloads that map it onto them.
struct Mapped {
  std::vector<Index> classes;
  std::vector<double> maps;
  Eigen::MatrixXd misfit;  // [points x classes]
};

Mapped mapped(const ClassCurves& curves) {
  Mapped all;
  all.misfit.setZero(kPoints, curves.reading.cols());
  for (Index c = 1; c < curves.reading.cols(); ++c) {
    const Mapping mapping(curves, {c}, false);
    const std::vector<double> map = bestFrom(errorOf(mapping), {{0, -1}, {0, 0}, {0, 1}});
    if (map.empty()) continue;
    mapping.putMisfit(map, all.misfit);
    all.classes.push_back(c);
    all.maps.insert(all.maps.end(), map.begin(), map.end());
  }
  return all;
}

// The best limit that all curves have in common, with the misfit that it leaves.
Limit limitOf(const ClassCurves& curves, const Mapped& plain, Eigen::MatrixXd& misfit) {
  std::vector<std::vector<double>> starts;
  for (const double gain : {0.7, 1.0, 1.5}) {
    starts.push_back(plain.maps);
    for (std::size_t k = 0; k < plain.maps.size(); k += 2) starts.back()[k] = gain * (1 + plain.maps[k]) - 1;
  }
  const Mapping mapping(curves, plain.classes, true);
  const std::vector<double> at = bestFrom(errorOf(mapping), starts);
  misfit = plain.misfit;
  if (at.empty()) return noLimit(curves.reading.maxCoeff());
  mapping.putMisfit(at, misfit);
  return mapping.limit(at);
}

// `chance`: variance of the curves [points x classes].
void takeOffChance(const Eigen::MatrixXd& chance, Eigen::MatrixXd& misfit) {
  for (Index c = 1; c < misfit.cols(); ++c) {
    for (Index k = 0; k < kPoints; ++k) {
      const double beyond = std::abs(misfit(k, c)) - kSure * std::sqrt(chance(k, c) + chance(k, 0));
      misfit(k, c) = std::copysign(std::max(0.0, beyond), misfit(k, c));
    }
  }
}

double highestReading(const Measured& measured) {
  double highest = 0;
  std::vector<double> readings;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    measured.readings(i, readings);
    for (std::size_t t = 0; t < readings.size(); ++t) {
      if (measured.used[t]) highest = std::max(highest, readings[t]);
    }
  }
  return highest;
}

// The parameters with which the simulation's effect comes nearest to a limit. No taxel reads more than the
// level, `above` [share of full scale].
void tellLimit(const Limit& limit, double above, double full_scale, StaticMisfit& misfit) {
  const simulation::EffectEntry& saturation =
      *simulation::findEffect(simulation::foundBy(simulation::Detector::kSaturation).id);
  const double highest = 2 * limit.knots[0];
  const Eigen::VectorXd readings = Eigen::VectorXd::LinSpaced(kPoints, highest / kPoints, highest);
  std::vector<double> unlimited;  // [counts]
  for (const double reading : readings) unlimited.push_back(full_scale * limit.without(reading));
  const auto levelAt = [&](const std::vector<double>& at) {
    return full_scale * above * (1.02 + std::exp(at[0]));
  };
  const auto sharpnessAt = [](const std::vector<double>& at) { return 1 + std::exp(at[1]); };
  const auto error = [&](const std::vector<double>& at) -> std::optional<Eigen::VectorXd> {
    simulation::TaxelSignals signals;
    signals.reading = unlimited;
    saturation.make({{"level", levelAt(at)}, {"sharpness", sharpnessAt(at)}}, {})->apply({}, signals);
    const Eigen::Map<const Eigen::VectorXd> limited(signals.reading.data(), kPoints);
    return Eigen::VectorXd(limited / full_scale - readings);
  };
  const std::vector<double> at = bestFrom(error, {{-3, 1}, {-3, 2}, {-1, 1}, {-1, 2}});
  misfit.level = levelAt(at);
  misfit.sharpness = sharpnessAt(at);
}

}  // namespace

StaticMisfit findStaticMisfit(const Measured& measured, const StaticFit& fit, const Trace& common,
                              double square) {
  StaticMisfit result;
  if (measured.classes.size() < 2) return result;
  const std::vector<double>& load = measured.loads();
  const auto [least, most] = std::minmax_element(load.begin(), load.end());
  const double low = std::max(0.0, *least), step = (*most - low) / (kPoints - 1);
  std::vector<std::size_t> sample_of(measured.classes.size(), measured.samples());
  for (std::size_t i = 0; i < measured.samples(); ++i) sample_of[measured.classOf(i)] = i;
  ClassCurves curves{Eigen::MatrixXd(kPoints, static_cast<Index>(measured.classes.size())),
                     coveredBy(measured, fit), low, step};
  for (Index c = 0; c < curves.reading.cols(); ++c) {
    for (Index k = 0; k < kPoints; ++k)
      curves.reading(k, c) =
          fit.curveAt(sample_of[static_cast<std::size_t>(c)], curves.load(k)) - fit.unloaded();
  }
  const Eigen::MatrixXd chance = chanceOf(measured, fit, common, low, step);
  const Mapped plain = mapped(curves);
  Eigen::MatrixXd misfit = plain.misfit, beside_limit;
  takeOffChance(chance, misfit);
  const double mean = misfit.squaredNorm() / static_cast<double>(misfit.size());
  result.rms = std::sqrt(mean);
  result.share = square > 0 ? mean / square : 0;
  result.at_map = atMap(misfit, curves.reading, step);
  if (result.share < thresholds::kLeastShareOfError) return result;
  const Limit limit = limitOf(curves, plain, beside_limit);
  takeOffChance(chance, beside_limit);
  result.by_limit = 1 - beside_limit.squaredNorm() / misfit.squaredNorm();
  tellLimit(limit, highestReading(measured), measured.full_scale, result);
  const Eigen::VectorXd by_pressure = misfit.rowwise().norm();
  result.pressure = {INFINITY, 0};
  for (Index k = 0; k < by_pressure.size(); ++k) {
    if (by_pressure[k] < thresholds::kPressureShows * by_pressure.maxCoeff()) continue;
    result.pressure.low = std::min(result.pressure.low, low + step * static_cast<double>(k));
    result.pressure.high = std::max(result.pressure.high, low + step * static_cast<double>(k));
  }
  const Eigen::VectorXd by_class = misfit.colwise().norm();
  for (Index c = 0; c < by_class.size(); ++c) {
    if (by_class[c] >= thresholds::kShows * by_class.maxCoeff())
      result.conditions.push_back(measured.classes[static_cast<std::size_t>(c)].surface);
  }
  return result;
}

}  // namespace fsr::discrepancy
