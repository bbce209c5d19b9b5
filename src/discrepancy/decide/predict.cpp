#include "discrepancy/decide/predict.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "discrepancy/decide/changes.h"
#include "discrepancy/fit/levenberg.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kSizeDifference = 0.02;        // of the size's logarithm
constexpr double kSmallest = -4, kLargest = 2;  // logarithm of the size of predicted effects

// Effects with fixed parameters in recordings that they were not fitted to. The first variable is the
// logarithm of the common factor of all strengths; the parameters of the spread follow.
class Predictor {
 public:
  Predictor(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
            const simulation::SimulationSettings& base, const std::vector<simulation::EnabledEffect>& effects,
            const ParameterSpread& spread)
      : measured_(measured),
        common_(common),
        fit_(fit),
        effects_(effects),
        spread_(spread),
        everywhere_(effects.size(), false),
        forward_(measured, common, fit, base, true) {}

  Predicted run() const;

 private:
  std::vector<simulation::EnabledEffect> effectsAt(const std::vector<double>& at) const;
  std::optional<Eigen::VectorXd> error(const std::vector<double>& at) const {
    return forward_.left(effectsAt(at), everywhere_);
  }
  static double sizeOf(double logarithm) { return std::exp(std::clamp(logarithm, kSmallest, kLargest)); }
  // Derivative of the error with respect to the size.
  Eigen::VectorXd slopeAt(double logarithm) const {
    const double inside = std::clamp(logarithm, kSmallest + kSizeDifference, kLargest - kSizeDifference);
    const Residuals residuals = [this](const std::vector<double>& at) { return error(at); };
    return derivatives(residuals, {inside}, *error({inside}), kSizeDifference).col(0) / sizeOf(inside);
  }
  void judgeCycles(const Eigen::VectorXd& slope, const Eigen::VectorXd& left, Predicted& told) const;
  double bySpread(const Eigen::VectorXd& slope, const Eigen::VectorXd& left) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const std::vector<simulation::EnabledEffect>& effects_;
  const ParameterSpread& spread_;
  std::vector<bool> everywhere_;  // no effect acts on bent surfaces only
  Forward forward_;
};

std::vector<simulation::EnabledEffect> Predictor::effectsAt(const std::vector<double>& at) const {
  std::vector<simulation::EnabledEffect> effects = effects_;
  for (std::size_t k = 1; k < at.size(); ++k) {
    const ParameterSpread::Parameter& one = spread_.parameters[k - 1];
    double& value = effects[one.effect].values[one.name];
    const settings::Range& permitted =
        simulation::parameter(measured_.info(effects[one.effect].id), one.name).permitted;
    value =
        std::clamp(one.logarithmic ? value * std::exp(at[k]) : value + at[k], permitted.low, permitted.high);
  }
  for (simulation::EnabledEffect& effect : effects) {
    for (const simulation::EffectParameter& parameter : simulation::strengths(measured_.info(effect.id)))
      effect.values[parameter.name] *= sizeOf(at[0]);
  }
  return effects;
}

// The size that each cycle gives, and the variance of the common one, clustered by cycle and corrected for
// one fitted number.
void Predictor::judgeCycles(const Eigen::VectorXd& slope, const Eigen::VectorXd& left,
                            Predicted& told) const {
  double squares = 0;
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    const double pull = slope.segment(first, samples).dot(left.segment(first, samples));
    told.information.push_back(slope.segment(first, samples).squaredNorm());
    told.apart.push_back(-pull / std::max(1e-300, told.information.back()));
    squares += pull * pull;
  }
  const auto cycles = static_cast<double>(measured_.fitCycles());
  told.variance =
      squares / std::max(1e-300, std::pow(slope.squaredNorm(), 2)) * cycles / std::max(1.0, cycles - 1);
}

// A parameter that is wrong by d changes the size that fits best by d times (its derivative along that of the
// size). Each derivative is taken over a third of the parameter's standard deviation, at size 1.
double Predictor::bySpread(const Eigen::VectorXd& slope, const Eigen::VectorXd& left) const {
  const auto size = static_cast<Eigen::Index>(spread_.parameters.size());
  Eigen::VectorXd along = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (Eigen::Index l = 0; l < size; ++l)
      covariance(k, l) = spread_.covariance[row][static_cast<std::size_t>(l)];
    const double step = std::sqrt(std::max(0.0, covariance(k, k))) / 3;
    if (!(step > 0)) continue;
    std::vector<double> moved(spread_.parameters.size() + 1, 0.0);
    double width = 0;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(left.size());
    for (const double side : {-1.0, 1.0}) {
      moved[row + 1] = side * step;
      const auto there = error(moved);
      if (!there) continue;
      change += side * (*there - left);
      width += step;
    }
    if (width > 0) along[k] = slope.dot(change) / width / std::max(1e-300, slope.squaredNorm());
  }
  return std::max(0.0, along.dot(covariance * along));
}

Predicted Predictor::run() const {
  Predicted told;
  told.trace = Trace::Zero(common_.all.size());
  const Residuals residuals = [this](const std::vector<double>& at) { return error(at); };
  const double before = withoutHoldOut(measured_, fit_.project(common_.all)).squaredNorm();
  const auto as_told = error({0});
  if (!as_told || before <= 0) return told;
  told.share = 1 - as_told->squaredNorm() / before;
  const std::vector<double> at = levenberg(residuals, {0}, {12, 0.02, 1e-5});
  const auto best = error(at);
  told.size = sizeOf(at[0]);
  judgeCycles(slopeAt(at[0]), *best, told);
  told.of_spread = bySpread(slopeAt(0), *as_told);
  told.trace = forward_.explained(effectsAt(at), everywhere_);
  return told;
}

}  // namespace

Predicted predict(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                  const simulation::SimulationSettings& base,
                  const std::vector<simulation::EnabledEffect>& effects, const ParameterSpread& spread) {
  return Predictor(measured, common, fit, base, effects, spread).run();
}

}  // namespace fsr::discrepancy
