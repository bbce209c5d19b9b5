#include "discrepancy/decide/refine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/parameter_fit.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::discrepancy {

namespace {

// Removes the added effects of the other kind. With `read_out` the effects of the read-out stay, otherwise
// those up to the gain.
simulation::SimulationSettings keepStages(simulation::SimulationSettings settings,
                                          const simulation::SimulationSettings& base, bool read_out) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const simulation::EnabledEffect& effect) {
                                 const bool late = simulation::libraryOf(base).info(effect.id).stage >=
                                                   simulation::ChainStage::kConductance;
                                 return !base.effect(effect.id) && late != read_out;
                               }),
                effects.end());
  return settings;
}

// Replaces the changes on flat surfaces by those of `flat`.
void onFlat(const Measured& measured, const Changes& flat, Changes& changes) {
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (!dataset::isFlat(measured.classes[measured.classOf(i)])) continue;
    const auto at = static_cast<Eigen::Index>(i);
    changes.load[at] = flat.load[at];
    changes.reading[at] = flat.reading[at];
    changes.gain[at] = flat.gain[at];
  }
}

// Scales the gain to a mean of 1 in each class of curvature. A gain that a whole class shares is part of its
// static curve. Without the scaling the residual, including the noise, would be divided by this gain, and a
// large gain would seem to explain it. With the scaling this cannot happen: where the mean of g is 1, the
// mean of 1 / g^2 is at least 1.
void levelGain(const Measured& measured, Changes& changes) {
  const auto classes = static_cast<Eigen::Index>(measured.classes.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(classes), number = sum;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    sum[c] += changes.gain[static_cast<Eigen::Index>(i)];
    number[c] += 1;
  }
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    changes.gain[static_cast<Eigen::Index>(i)] *= number[c] / std::max(1e-9, sum[c]);
  }
}

Trace freedOf(const Trace& common, double unloaded, const Changes& changes) {
  return ((common - changes.reading).array() - unloaded) / changes.gain.array().max(0.05) + unloaded;
}

}  // namespace

simulation::SimulationSettings withEffect(simulation::SimulationSettings settings,
                                          const simulation::EnabledEffect& effect) {
  const std::vector<std::string> order = simulation::libraryOf(settings).ids();
  const auto place = [&](const std::string& id) { return std::find(order.begin(), order.end(), id); };
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const simulation::EnabledEffect& e) { return e.id == effect.id; }),
                effects.end());
  const auto after = std::find_if(effects.begin(), effects.end(), [&](const simulation::EnabledEffect& e) {
    return place(e.id) > place(effect.id);
  });
  effects.insert(after, effect);
  return settings;
}

Changes changesBy(const Measured& measured, const simulation::SimulationSettings& base,
                  const simulation::SimulationSettings& added, const DrivenSignals& without) {
  const simulation::SimulationSettings early = keepStages(added, base, false),
                                       late = keepStages(added, base, true);
  const auto samples = without.load.size();
  Changes changes{Trace::Zero(samples), Trace::Ones(samples), Trace::Zero(samples)};
  if (early.effects.size() > base.effects.size()) {
    const DrivenSignals with = driven(measured, early);
    changes.load = with.load - without.load;
    changes.gain = with.gain.cwiseQuotient(without.gain.cwiseMax(1e-9));
  }
  if (late.effects.size() > base.effects.size()) {
    changes.reading = driven(measured, late).reading - without.reading;
  }
  return changes;
}

Trace loadOf(const Measured& measured, const Changes& changes) {
  return Eigen::Map<const Trace>(measured.loads().data(), changes.load.size()) + changes.load;
}

// A trace that is 0 in the hold-out cycles.
Trace withoutHoldOut(const Measured& measured, Trace trace) {
  for (const MeasuredCycle& cycle : measured.cycles) {
    if (cycle.use == CycleUse::kFit) continue;
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    trace.segment(static_cast<Eigen::Index>(cycle.first), samples).setZero();
  }
  return trace;
}

Changes Forward::changes(const std::vector<simulation::EnabledEffect>& effects,
                         const std::vector<bool>& bent_only) const {
  simulation::SimulationSettings bent = base_, flat = base_;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    bent = withEffect(bent, effects[e]);
    if (!bent_only[e]) flat = withEffect(flat, effects[e]);
  }
  Changes changes = changesBy(measured_, base_, bent, plain_);
  if (flat.effects.size() < bent.effects.size())
    onFlat(measured_, changesBy(measured_, base_, flat, plain_), changes);
  levelGain(measured_, changes);
  return changes;
}

std::optional<Trace> Forward::left(const std::vector<simulation::EnabledEffect>& effects,
                                   const std::vector<bool>& bent_only) const {
  try {
    const Changes changes = this->changes(effects, bent_only);
    const Trace freed = freedOf(common_.all, fit_.unloaded(), changes);
    return withoutHoldOut(measured_, StaticFit(fit_, freed, loadOf(measured_, changes)).project(freed));
  } catch (const settings::InputError&) {
    return std::nullopt;
  }
}

Trace Forward::explained(const std::vector<simulation::EnabledEffect>& effects,
                         const std::vector<bool>& bent_only) const {
  const Changes changes = this->changes(effects, bent_only);
  const Trace freed = freedOf(common_.all, fit_.unloaded(), changes);
  const Trace after = StaticFit(fit_, freed, loadOf(measured_, changes)).residual(freed);
  return fit_.residual(common_.all) - after.cwiseProduct(changes.gain);
}

// Signatures are derivatives at strength zero. A large effect is not linear in its strength, and the trace
// of its shape is not a multiple of the traces of the tried shapes. So the parameters of the chosen effects
// are fitted again through the whole chain. Method: K. Levenberg, 1944, D. Marquardt, 1963, with derivatives
// by differences.

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
          std::vector<bool> bent_only)
      : measured_(measured),
        common_(common),
        fit_(fit),
        effects_(std::move(effects)),
        bent_only_(std::move(bent_only)),
        forward_(measured, common, fit, base) {
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
               const std::vector<simulation::EnabledEffect>& start, std::vector<bool> bent_only) {
  return Refiner(measured, common, fit, base, start, std::move(bent_only)).run();
}

void takeOut(Measured& measured, const StaticFit& fit, const simulation::SimulationSettings& without,
             const simulation::SimulationSettings& with) {
  const Changes changes = changesBy(measured, without, with, driven(measured, without));
  const Trace load = loadOf(measured, changes);
  if (measured.gain.empty()) {
    measured.unloaded = fit.unloaded();
    measured.gain.assign(measured.samples(), 1.0);
    measured.added.assign(measured.samples(), 0.0);
  }
  measured.load.assign(load.data(), load.data() + load.size());
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    measured.gain[i] *= changes.gain[static_cast<Eigen::Index>(i)];
    measured.added[i] += changes.reading[static_cast<Eigen::Index>(i)];
  }
}

bool hasTimeCourse(const simulation::EffectInfo& info) {
  return (info.kind == simulation::EffectKind::kAdditive || info.kind == simulation::EffectKind::kGrid) &&
         !isStatic(info) && info.detector == simulation::Detector::kNone;
}

simulation::SimulationSettings takeOutEnabled(Measured& measured, const CommonTraces& common,
                                              const StaticFit& fit,
                                              const simulation::SimulationSettings& base, bool fit_sizes,
                                              const std::vector<simulation::EnabledEffect>& beside) {
  simulation::SimulationSettings still = base, with = base;
  std::vector<simulation::EnabledEffect> moving;
  still.effects.clear();
  for (const simulation::EnabledEffect& effect : base.effects) {
    const bool moves = hasTimeCourse(measured.info(effect.id));
    (moves ? moving : still.effects).push_back(effect);
  }
  if (moving.empty()) return base;
  const std::size_t enabled = moving.size();
  moving.insert(moving.end(), beside.begin(), beside.end());
  if (fit_sizes) {
    const Refined refined = refine(measured, common, fit, still, moving, {});
    for (std::size_t e = 0; refined.share > 0 && e < enabled; ++e)
      with = withEffect(with, refined.effects[e]);
  }
  takeOut(measured, fit, still, with);
  return with;
}

}  // namespace fsr::discrepancy
