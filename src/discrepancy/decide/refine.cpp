// Signatures are derivatives at strength zero. A large effect is not linear in its strength, and the trace
// of its shape is not a multiple of the traces of the tried shapes. So the parameters of the chosen effects
// are fitted again through the whole chain. Method: K. Levenberg, 1944, D. Marquardt, 1963, with derivatives
// by differences.

#include "discrepancy/decide/refine.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/levenberg.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kDifference = 0.02;  // of a parameter's scale
constexpr double kBeyondTried = 3;    // factor by which a shape may exceed its plausible range
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

// Changes of load, gain and reading by effects.
struct Changes {
  Trace load, gain, reading;  // [Pa], factor, [share of full scale]
};

Changes changesBy(const Measured& measured, const simulation::SimulationSettings& base,
                  const simulation::SimulationSettings& added, const DrivenSignals& without,
                  bool state_kept) {
  const simulation::SimulationSettings early = keepStages(added, base, false),
                                       late = keepStages(added, base, true);
  const auto samples = without.load.size();
  Changes changes{Trace::Zero(samples), Trace::Ones(samples), Trace::Zero(samples)};
  if (early.effects.size() > base.effects.size()) {
    const DrivenSignals with = driven(measured, early, state_kept);
    changes.load = with.load - without.load;
    changes.gain = with.gain.cwiseQuotient(without.gain.cwiseMax(1e-9));
  }
  if (late.effects.size() > base.effects.size()) {
    changes.reading = driven(measured, late, state_kept).reading - without.reading;
  }
  return changes;
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

Trace loadOf(const Measured& measured, const Changes& changes) {
  const std::vector<double>& load = measured.load.empty() ? measured.pressure : measured.load;
  return Eigen::Map<const Trace>(load.data(), changes.load.size()) + changes.load;
}

class Refiner {
 public:
  Refiner(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
          const simulation::SimulationSettings& base, std::vector<simulation::EnabledEffect> effects,
          bool state_kept, std::vector<bool> bent_only)
      : measured_(measured),
        common_(common),
        fit_(fit),
        base_(base),
        effects_(std::move(effects)),
        state_kept_(state_kept),
        bent_only_(std::move(bent_only)),
        plain_(driven(measured, base, state_kept)) {
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
  Changes changesAt(const std::vector<double>& at) const {
    simulation::SimulationSettings bent = base_, flat = base_;
    const std::vector<simulation::EnabledEffect> effects = effectsAt(at);
    for (std::size_t e = 0; e < effects.size(); ++e) {
      bent = withEffect(bent, effects[e]);
      if (!bent_only_[e]) flat = withEffect(flat, effects[e]);
    }
    Changes changes = changesBy(measured_, base_, bent, plain_, state_kept_);
    if (flat.effects.size() < bent.effects.size())
      onFlat(measured_, changesBy(measured_, base_, flat, plain_, state_kept_), changes);
    levelGain(measured_, changes);
    return changes;
  }
  Trace withoutHoldOut(Trace trace) const {
    for (const MeasuredCycle& cycle : measured_.cycles) {
      if (cycle.use == CycleUse::kFit) continue;
      const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
      trace.segment(static_cast<Eigen::Index>(cycle.first), samples).setZero();
    }
    return trace;
  }
  // Variable projection: for given parameters the curves are fitted by least squares.
  std::optional<Eigen::VectorXd> error(const std::vector<double>& at) const {
    try {
      const Changes changes = changesAt(at);
      const Trace freed = freedOf(common_.all, fit_.unloaded(), changes);
      return withoutHoldOut(StaticFit(fit_, freed, loadOf(measured_, changes)).project(freed));
    } catch (const settings::InputError&) {
      return std::nullopt;
    }
  }
  void makePermitted();
  std::vector<double> deviations(const Eigen::VectorXd& left) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const simulation::SimulationSettings& base_;
  std::vector<simulation::EnabledEffect> effects_;
  bool state_kept_;
  std::vector<bool> bent_only_;  // of each effect
  std::vector<Knob> knobs_;
  std::vector<double> at_;
  DrivenSignals plain_;
};

// Standard deviations of the fitted parameters, clustered by cycle: residuals within one cycle are
// correlated.
std::vector<double> Refiner::deviations(const Eigen::VectorXd& left) const {
  const auto residuals = [this](const std::vector<double>& at) { return error(at); };
  const Eigen::MatrixXd jacobian = derivatives(residuals, at_, left, kDifference);
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
  const Eigen::VectorXd variance = (inverse * spread * inverse).diagonal();
  std::vector<double> deviations;
  for (Eigen::Index k = 0; k < variance.size(); ++k)
    deviations.push_back(std::sqrt(std::max(0.0, variance[k])));
  return deviations;
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
  refined.share = 1 - left->squaredNorm() / withoutHoldOut(fit_.project(common_.all)).squaredNorm();
  const Changes changes = changesAt(at_);
  const Trace freed = freedOf(common_.all, fit_.unloaded(), changes);
  const Trace after = StaticFit(fit_, freed, loadOf(measured_, changes)).residual(freed);
  refined.trace = fit_.residual(common_.all) - after.cwiseProduct(changes.gain);
  const std::vector<double> deviation = deviations(*left);
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    const Knob& knob = knobs_[k];
    const simulation::EffectParameter& info =
        simulation::parameter(measured_.info(effects_[knob.effect].id), knob.name);
    const double value = knob.write(at_[k]), half = kTwoSided * deviation[k];
    refined.parameters[knob.effect].push_back(
        {knob.name, value, info.permitted.unit, {knob.write(at_[k] - half), knob.write(at_[k] + half)}});
    const bool strength = info.role == simulation::ParameterRole::kStrength;
    if (strength && !info.plausible.contains(value)) refined.at_bound = true;
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

void takeOut(Measured& measured, const StaticFit& fit, const simulation::SimulationSettings& without,
             const simulation::SimulationSettings& with) {
  const Changes changes = changesBy(measured, without, with, driven(measured, without, true), true);
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
    const Refined refined = refine(measured, common, fit, still, moving, true, {});
    for (std::size_t e = 0; refined.share > 0 && e < enabled; ++e)
      with = withEffect(with, refined.effects[e]);
  }
  takeOut(measured, fit, still, with);
  return with;
}

Predicted predict(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                  const simulation::SimulationSettings& base,
                  const std::vector<simulation::EnabledEffect>& effects) {
  const DrivenSignals plain = driven(measured, base, true);
  const Residuals residuals = [&](const std::vector<double>& at) -> std::optional<Eigen::VectorXd> {
    simulation::SimulationSettings with = base;
    for (simulation::EnabledEffect effect : effects) {
      for (const simulation::EffectParameter& parameter : simulation::strengths(measured.info(effect.id))) {
        effect.values[parameter.name] *= std::exp(std::clamp(at[0], -4.0, 2.0));
      }
      with = withEffect(with, effect);
    }
    try {
      Changes changes = changesBy(measured, base, with, plain, true);
      levelGain(measured, changes);
      const Trace freed = freedOf(common.all, fit.unloaded(), changes);
      return StaticFit(fit, freed, loadOf(measured, changes)).project(freed);
    } catch (const settings::InputError&) {
      return std::nullopt;
    }
  };
  Predicted told;
  const double before = fit.project(common.all).squaredNorm();
  const auto as_told = residuals({0});
  if (!as_told || before <= 0) return told;
  told.share = 1 - as_told->squaredNorm() / before;
  const std::vector<double> at = levenberg(residuals, {0}, {12, 0.02, 1e-5});
  const auto best = residuals(at);
  told.best_share = 1 - best->squaredNorm() / before;
  told.size = std::exp(std::clamp(at[0], -4.0, 2.0));
  const Eigen::VectorXd slope = derivatives(residuals, at, *best, kDifference).col(0);
  double squares = 0;
  for (const MeasuredCycle& cycle : measured.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    squares += std::pow(slope.segment(first, samples).dot(best->segment(first, samples)), 2);
  }
  const double half = kTwoSided * std::sqrt(squares) / std::max(1e-300, slope.squaredNorm());
  told.interval = {told.size * std::exp(-half), told.size * std::exp(half)};
  return told;
}

Refined refine(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
               const simulation::SimulationSettings& base,
               const std::vector<simulation::EnabledEffect>& start, bool state_kept,
               std::vector<bool> bent_only) {
  return Refiner(measured, common, fit, base, start, state_kept, std::move(bent_only)).run();
}

}  // namespace fsr::discrepancy
