// Signatures are derivatives at strength zero. A large effect is not linear in its strength, and the trace
// of its shape is not a multiple of the traces of the tried shapes. So the parameters of the chosen effects
// are fitted again through the whole chain. Method: K. Levenberg, 1944, D. Marquardt, 1963, with derivatives
// by differences.

#include "discrepancy/decide/refine.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "discrepancy/decide/changes.h"
#include "discrepancy/fit/levenberg.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kScaleDifference = 0.02;  // of a parameter's scale
constexpr double kBeyondTried = 3;         // factor by which a shape may exceed its plausible range
constexpr int kMostHalved = 8;
constexpr double kTwoSided = 1.96;  // 95 % of a normal distribution

// One fitted parameter. It is scaled so that a step of about 1 is large.
struct Knob {
  std::size_t effect;
  std::string name;
  settings::Range range;
  bool logarithmic;
  double scale;
  bool is_strength;

  double read(double value) const { return logarithmic ? std::log(value) : value / scale; }
  double write(double x) const {
    return std::clamp(logarithmic ? std::exp(x) : x * scale, range.low, range.high);
  }
};

settings::Range rangeOf(const simulation::EffectParameter& parameter) {
  if (parameter.role == simulation::ParameterRole::kStrength) return parameter.permitted;
  const double low = parameter.plausible.low, high = parameter.plausible.high;
  settings::Range range = parameter.permitted;
  if (low > 0) range.low = std::max(range.low, low / kBeyondTried);
  if (high > 0 && low > 0) range.high = std::min(range.high, high * kBeyondTried);
  return range;
}

std::vector<Knob> knobsOf(const simulation::EffectLibrary& library,
                          const std::vector<simulation::EnabledEffect>& effects) {
  std::vector<Knob> knobs;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    for (const simulation::EffectParameter& parameter : library.info(effects[e].id).parameters) {
      const bool strength = parameter.role == simulation::ParameterRole::kStrength;
      const bool shape = parameter.role == simulation::ParameterRole::kShape && !parameter.tried.empty();
      const double value = effects[e].values.at(parameter.name);
      if (!(strength ? value != parameter.neutral : shape) || !std::isfinite(value)) continue;
      const bool logarithmic = shape && value > 0 && parameter.permitted.low > 0;
      const double scale = strength ? std::max(std::abs(value), 1e-12) : 1;
      knobs.push_back({e, parameter.name, rangeOf(parameter), logarithmic, scale, strength});
    }
  }
  return knobs;
}

class Refiner {
 public:
  Refiner(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
          const simulation::SimulationSettings& base, std::vector<simulation::EnabledEffect> effects,
          bool state_kept, std::vector<bool> bent_only)
      : measured_(measured),
        common_(common),
        fit_(fit),
        effects_(std::move(effects)),
        state_kept_(state_kept),
        bent_only_(std::move(bent_only)),
        forward_(measured, common, fit, base, state_kept) {
    bent_only_.resize(effects_.size(), false);
    knobs_ = knobsOf(simulation::libraryOf(base), effects_);
    for (const Knob& knob : knobs_) at_.push_back(knob.read(effects_[knob.effect].values.at(knob.name)));
  }

  Refined run();

 private:
  std::vector<simulation::EnabledEffect> effectsAt(const std::vector<double>& at) const {
    std::vector<simulation::EnabledEffect> effects = effects_;
    for (std::size_t k = 0; k < knobs_.size(); ++k) {
      effects[knobs_[k].effect].values[knobs_[k].name] = knobs_[k].write(at[k]);
    }
    return effects;
  }
  std::optional<Eigen::VectorXd> error(const std::vector<double>& at) const {
    return forward_.left(effectsAt(at), bent_only_);
  }
  void makePermitted();
  Eigen::MatrixXd covariance(const Eigen::VectorXd& left) const;
  ParameterSpread spreadOf(const Eigen::MatrixXd& covariance) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  std::vector<simulation::EnabledEffect> effects_;
  bool state_kept_;
  std::vector<bool> bent_only_;  // of each effect
  std::vector<Knob> knobs_;
  std::vector<double> at_;
  Forward forward_;
};

// Covariance of the fitted parameters, clustered by cycle: residuals within one cycle are correlated. A shape
// at an end of its range is not free.
Eigen::MatrixXd Refiner::covariance(const Eigen::VectorXd& left) const {
  const auto residuals = [this](const std::vector<double>& at) { return error(at); };
  Eigen::MatrixXd jacobian = derivatives(residuals, at_, left, kScaleDifference);
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    const double value = knobs_[k].write(at_[k]);
    const bool at_end = value <= knobs_[k].range.low || value >= knobs_[k].range.high;
    if (at_end && !knobs_[k].is_strength) jacobian.col(static_cast<Eigen::Index>(k)).setZero();
  }
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    const Eigen::VectorXd pull =
        jacobian.middleRows(first, samples).transpose() * left.segment(first, samples);
    spread += pull * pull.transpose();
  }
  Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  normal.diagonal().array() *= 1 + 1e-9;
  normal.diagonal().array() += 1e-300;
  const Eigen::MatrixXd inverse =
      normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  return inverse * spread * inverse;
}

// The covariance together with what is known without the recordings: a shape lies within the range of the fit
// with 95 %. Where the recordings hardly determine a shape, its spread is otherwise too large to be linear.
ParameterSpread Refiner::spreadOf(const Eigen::MatrixXd& covariance) const {
  ParameterSpread result;
  const auto size = static_cast<Eigen::Index>(knobs_.size());
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(size), unit(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const Knob& knob = knobs_[static_cast<std::size_t>(k)];
    result.parameters.push_back({knob.effect, knob.name, knob.logarithmic});
    unit[k] = knob.logarithmic ? 1 : knob.scale;
    const double width = knob.logarithmic ? std::log(knob.range.high / knob.range.low)
                                          : (knob.range.high - knob.range.low) / knob.scale;
    if (!knob.is_strength && std::isfinite(width) && width > 0)
      precision[k] = std::pow(2 * kTwoSided / width, 2);
  }
  const Eigen::MatrixXd known = Eigen::MatrixXd::Identity(size, size) + precision.asDiagonal() * covariance;
  const Eigen::MatrixXd half = covariance * known.partialPivLu().inverse();
  const Eigen::MatrixXd both = unit.asDiagonal() * (0.5 * (half + half.transpose())) * unit.asDiagonal();
  for (Eigen::Index k = 0; k < size; ++k) {
    result.covariance.emplace_back();
    for (Eigen::Index l = 0; l < size; ++l) result.covariance.back().push_back(both(k, l));
  }
  result.cycles = measured_.fitCycles();
  return result;
}

// Halves the strengths until they are permitted. Signatures are linear, so the strength that they give for a
// large effect may be more than the effect permits.
void Refiner::makePermitted() {
  for (int halved = 0; halved < kMostHalved && !error(at_); ++halved) {
    for (std::size_t k = 0; k < knobs_.size(); ++k) {
      if (!knobs_[k].logarithmic && knobs_[k].is_strength) at_[k] /= 2;
    }
  }
}

// Whether even the end of the interval that is nearer to no effect is beyond the plausible strengths. An
// effect that is smaller than usual is not implausible.
bool isTooLarge(const FittedParameter& fitted, const simulation::EffectParameter& strength) {
  if (fitted.value > strength.neutral)
    return fitted.interval.low > std::max(strength.plausible.high, strength.neutral);
  return fitted.interval.high < std::min(strength.plausible.low, strength.neutral);
}

Refined Refiner::run() {
  makePermitted();
  at_ = levenberg([this](const std::vector<double>& at) { return error(at); }, at_);
  for (std::size_t k = 0; k < at_.size(); ++k) at_[k] = knobs_[k].read(knobs_[k].write(at_[k]));
  Refined refined;
  refined.effects = effectsAt(at_);
  refined.state_kept = state_kept_;
  refined.parameters.resize(effects_.size());
  refined.trace = Trace::Zero(common_.all.size());
  const auto left = error(at_);
  if (!left) return refined;
  refined.left = *left;
  refined.share =
      1 - left->squaredNorm() / withoutHoldOut(measured_, fit_.project(common_.all)).squaredNorm();
  refined.trace = forward_.explained(refined.effects, bent_only_);
  const Eigen::MatrixXd spread = covariance(*left);
  refined.spread = spreadOf(spread);
  const Eigen::VectorXd deviation = spread.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    const Knob& knob = knobs_[k];
    const simulation::EffectParameter& info =
        simulation::parameter(measured_.info(effects_[knob.effect].id), knob.name);
    const double value = knob.write(at_[k]), half = kTwoSided * deviation[static_cast<Eigen::Index>(k)];
    refined.parameters[knob.effect].push_back(
        {knob.name, value, info.permitted.unit, {knob.write(at_[k] - half), knob.write(at_[k] + half)}});
    if (info.role == simulation::ParameterRole::kStrength)
      refined.implausible = refined.implausible || isTooLarge(refined.parameters[knob.effect].back(), info);
  }
  return refined;
}

}  // namespace

bool mayBeNone(const Refined& refined, const simulation::EffectLibrary& library) {
  bool any = false;
  for (std::size_t e = 0; e < refined.parameters.size(); ++e) {
    const simulation::EffectInfo& info = library.info(refined.effects[e].id);
    for (const FittedParameter& fitted : refined.parameters[e]) {
      const simulation::EffectParameter& known = simulation::parameter(info, fitted.name);
      if (known.role != simulation::ParameterRole::kStrength) continue;
      if (fitted.interval.low > known.neutral || fitted.interval.high < known.neutral) return false;
      any = true;
    }
  }
  return any;
}

Refined refine(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
               const simulation::SimulationSettings& base,
               const std::vector<simulation::EnabledEffect>& start, bool state_kept,
               std::vector<bool> bent_only) {
  return Refiner(measured, common, fit, base, start, state_kept, std::move(bent_only)).run();
}

}  // namespace fsr::discrepancy
