// Signatures are derivatives at "none of it"; a large effect bends, and its shapes are no multiples of the
// tried ones. So the parameters of the effects that were chosen are fitted once more through the whole chain.
// K. Levenberg, 1944, D. Marquardt, 1963, with derivatives by differences.

#include "fsr_pressure_map/discrepancy/refine.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "fsr_pressure_map/discrepancy/levenberg.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

constexpr int kRounds = 2;            // of curves and parameters in turn
constexpr double kDifference = 0.02;  // of a parameter's scale
constexpr double kBeyondTried = 3;    // factor that a shape may leave its tried values by
constexpr double kTwoSided = 1.96;    // 95 % of a normal distribution

// One number that is fitted, on a scale on which steps of about 1 are large.
struct Knob {
  std::size_t effect;
  std::string name;
  Range range;
  bool logarithmic;
  double scale;

  double read(double value) const { return logarithmic ? std::log(value) : value / scale; }
  double write(double x) const {
    return std::clamp(logarithmic ? std::exp(x) : x * scale, range.low, range.high);
  }
};

Range rangeOf(const EffectParameter& parameter) {
  if (parameter.role == ParameterRole::kStrength) return parameter.permitted;
  const double low = parameter.plausible.low, high = parameter.plausible.high;
  Range range = parameter.permitted;
  if (low > 0) range.low = std::max(range.low, low / kBeyondTried);
  if (high > 0 && low > 0) range.high = std::min(range.high, high * kBeyondTried);
  return range;
}

std::vector<Knob> knobsOf(const std::vector<EnabledEffect>& effects) {
  std::vector<Knob> knobs;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    for (const EffectParameter& parameter : findEffect(effects[e].id)->info.parameters) {
      const bool strength = parameter.role == ParameterRole::kStrength;
      const bool shape = parameter.role == ParameterRole::kShape && !parameter.tried.empty();
      const double value = effects[e].values.at(parameter.name);
      if (!(strength ? value != parameter.neutral : shape) || !std::isfinite(value)) continue;
      const bool logarithmic = shape && value > 0 && parameter.permitted.low > 0;
      const double scale = strength ? std::max(std::abs(value), 1e-12) : 1;
      knobs.push_back({e, parameter.name, rangeOf(parameter), logarithmic, scale});
    }
  }
  return knobs;
}

// Effects on load and gain go through the measured curves, those of the read-out add up.
SimulationSettings keepStages(SimulationSettings settings, const SimulationSettings& base, bool read_out) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const EnabledEffect& effect) {
                                 const bool late =
                                     findEffect(effect.id)->info.stage >= ChainStage::kConductance;
                                 return !base.effect(effect.id) && late != read_out;
                               }),
                effects.end());
  return settings;
}

Trace throughCurves(const Measured& measured, const StaticFit& fit, const DrivenSignals& without,
                    const DrivenSignals& with) {
  Trace added(without.load.size());
  for (Eigen::Index i = 0; i < added.size(); ++i) {
    const auto moment = static_cast<std::size_t>(i);
    const double value = fit.curveAt(moment, measured.pressure[moment] + with.load[i] - without.load[i]);
    const double ratio = without.gain[i] > 0 ? with.gain[i] / without.gain[i] : 1;
    const double zero = fit.curve()[i] - fit.rise()[i];
    added[i] = zero + (value - zero) * ratio - fit.curve()[i];
  }
  return added;
}

Trace traceBetween(const Measured& measured, const StaticFit& fit, const SimulationSettings& base,
                   const SimulationSettings& added, const DrivenSignals& without, bool carried) {
  const SimulationSettings early = keepStages(added, base, false), late = keepStages(added, base, true);
  Trace trace = Trace::Zero(without.load.size());
  if (early.effects.size() > base.effects.size()) {
    trace += throughCurves(measured, fit, without, driven(measured, early, carried));
  }
  if (late.effects.size() > base.effects.size()) {
    trace += driven(measured, late, carried).reading - without.reading;
  }
  return trace;
}

class Refiner {
 public:
  Refiner(const Measured& measured, const CommonTraces& common, const SimulationSettings& base,
          std::vector<EnabledEffect> effects, bool carried)
      : measured_(measured), common_(common), base_(base), effects_(std::move(effects)), carried_(carried) {
    knobs_ = knobsOf(effects_);
    for (const Knob& knob : knobs_) at_.push_back(knob.read(effects_[knob.effect].values.at(knob.name)));
    plain_ = driven(measured, base, carried);
  }

  Refined run() {
    Trace added = Trace::Zero(common_.all.size());
    for (int round = 0; round < kRounds; ++round) {
      fit_ = std::make_unique<StaticFit>(measured_, CurvePer::kClass, common_.all - added);
      target_ = fit_->project(common_.all);
      search();
      added = trace(at_);
    }
    return result(added);
  }

 private:
  std::vector<EnabledEffect> effectsAt(const std::vector<double>& at) const {
    std::vector<EnabledEffect> effects = effects_;
    for (std::size_t k = 0; k < knobs_.size(); ++k) {
      effects[knobs_[k].effect].values[knobs_[k].name] = knobs_[k].write(at[k]);
    }
    return effects;
  }
  // Throws InputError where parameters do not go together.
  Trace trace(const std::vector<double>& at) const {
    SimulationSettings with = base_;
    for (const EnabledEffect& effect : effectsAt(at)) with = withEffect(with, effect);
    return traceBetween(measured_, *fit_, base_, with, plain_, carried_);
  }
  Trace masked(const Trace& projected) const {
    Trace result = projected;
    for (const MeasuredCycle& cycle : measured_.cycles) {
      if (cycle.use == CycleUse::kFit) continue;
      result
          .segment(static_cast<Eigen::Index>(cycle.first),
                   static_cast<Eigen::Index>(cycle.last - cycle.first))
          .setZero();
    }
    return result;
  }
  Trace error(const std::vector<double>& at) const { return masked(target_ - fit_->project(trace(at))); }
  std::optional<Eigen::VectorXd> tryError(const std::vector<double>& at) const {
    try {
      return error(at);
    } catch (const InputError&) {
      return std::nullopt;
    }
  }
  void search();
  Refined result(const Trace& added) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const SimulationSettings& base_;
  std::vector<EnabledEffect> effects_;
  bool carried_;
  std::vector<Knob> knobs_;
  std::vector<double> at_;
  DrivenSignals plain_;
  std::unique_ptr<StaticFit> fit_;
  Trace target_;
};

void Refiner::search() {
  at_ = levenberg([this](const std::vector<double>& at) { return tryError(at); }, at_);
  for (std::size_t k = 0; k < at_.size(); ++k) at_[k] = knobs_[k].read(knobs_[k].write(at_[k]));
}

Refined Refiner::result(const Trace& added) const {
  Refined refined;
  refined.effects = effectsAt(at_);
  refined.parameters.resize(effects_.size());
  refined.trace = added;
  const Trace left = error(at_);
  refined.share = 1 - left.squaredNorm() / masked(target_).squaredNorm();
  const auto residuals = [this](const std::vector<double>& at) { return tryError(at); };
  const Eigen::MatrixXd jacobian = derivatives(residuals, at_, left, kDifference);
  // By cycles: what is left of one cycle hangs together.
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first),
               n = static_cast<Eigen::Index>(cycle.last - cycle.first);
    const Eigen::VectorXd pull = jacobian.middleRows(first, n).transpose() * left.segment(first, n);
    spread += pull * pull.transpose();
  }
  Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  normal.diagonal().array() *= 1 + 1e-9;
  const Eigen::MatrixXd inverse =
      normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  const Eigen::MatrixXd covariance = inverse * spread * inverse;
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    const Knob& knob = knobs_[k];
    const auto kk = static_cast<Eigen::Index>(k);
    const double half = kTwoSided * std::sqrt(std::max(0.0, covariance(kk, kk)));
    const EffectParameter& info = parameter(findEffect(effects_[knob.effect].id)->info, knob.name);
    const double value = knob.write(at_[k]);
    refined.parameters[knob.effect].push_back(
        {knob.name, value, info.permitted.unit, {knob.write(at_[k] - half), knob.write(at_[k] + half)}});
    const bool strength = info.role == ParameterRole::kStrength;
    if (strength && !info.plausible.contains(value)) refined.at_bound = true;
  }
  return refined;
}

}  // namespace

SimulationSettings withEffect(SimulationSettings settings, const EnabledEffect& effect) {
  const std::vector<std::string> order = effectIds();
  const auto place = [&](const std::string& id) { return std::find(order.begin(), order.end(), id); };
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const EnabledEffect& e) { return e.id == effect.id; }),
                effects.end());
  const auto after = std::find_if(effects.begin(), effects.end(),
                                  [&](const EnabledEffect& e) { return place(e.id) > place(effect.id); });
  effects.insert(after, effect);
  return settings;
}

Trace addedTrace(const Measured& measured, const StaticFit& fit, const SimulationSettings& base,
                 const SimulationSettings& added, bool carried) {
  return traceBetween(measured, fit, base, added, driven(measured, base, carried), carried);
}

Refined refine(const Measured& measured, const CommonTraces& common, const SimulationSettings& base,
               const std::vector<EnabledEffect>& start, bool carried) {
  return Refiner(measured, common, base, start, carried).run();
}

}  // namespace fsr
