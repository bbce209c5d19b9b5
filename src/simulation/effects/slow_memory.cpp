#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "rheology/memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

// Under a constant load the reading keeps rising, by the same share in each decade of time.
//
//     u = P_e + (1 - v) c(P_e),   g = g (1 + v c(P_e) / P_span),   c = a sum_i J_i * dP_e / 2
//
// J_i(t) = 1 - exp(-t / tau_i), with two tau_i a decade from the fastest to the slowest. A step of the load
// creeps by the share a in each decade between them and fades in the same way when the load is gone. v:
// share of the creep that changes the sensitivity; the rest acts like additional load.
// Size: data sheets call it "drift". < 2 % per log time (Tangio TPE-500 v1.8, 2018: 1 kg, 48 h), < 5 %
// log10(time) (Interlink FSR 400, PDS-10004-C: 1 kg, 35 days), < 5 % a decade (FlexiForce A201, from memory,
// not verified; its manual confirms the sign: the resistance falls).
// Source of the series: W. N. Findley et al., Creep and Relaxation of Nonlinear Viscoelastic Materials,
// Dover 1989, ch. 5.

namespace {

constexpr double kCreepElements = 2;

std::vector<rheology::ExponentialMemory> creepElements(double fastest, double slowest) {
  if (slowest < fastest)
    throw settings::InputError("effects.creep: slowest must not be shorter than fastest");
  const long steps = std::lround(kCreepElements * std::log10(slowest / fastest));
  std::vector<rheology::ExponentialMemory> memories;
  for (long i = 0; i <= steps; ++i) {
    memories.emplace_back(fastest * std::pow(10, static_cast<double>(i) / kCreepElements));
  }
  return memories;
}

class Creep : public Effect {
 public:
  Creep(const EffectValues& values, const EffectContext& context)
      : weight_(values.at("per_decade") / kCreepElements),
        load_share_(1 - values.at("gain_share")),
        gain_share_(values.at("gain_share") / values.at("span")),
        memories_(creepElements(values.at("fastest"), values.at("slowest"))),
        steps_(memories_.size()) {
    state_.assign(context.layout.size.taxels() * (1 + memories_.size()), 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    for (std::size_t k = 0; k < steps_.size(); ++k) steps_[k] = memories_[k].over(sample.elapsed);
    double* state = state_.data();  // of each taxel: the load at the scan before, then the memories [Pa]
    for (std::size_t i = 0; i < signals.load.size(); ++i) {
      const double crept = weight_ * advance(signals.load[i], state);
      signals.load[i] += load_share_ * crept;
      signals.gain[i] *= 1 + gain_share_ * crept;
      state += 1 + steps_.size();
    }
  }

 private:
  // Sum of a taxel's memories [Pa].
  double advance(double load, double* state) const {
    double sum = 0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      state[k + 1] = steps_[k](state[0], load, state[k + 1]);
      sum += state[k + 1];
    }
    state[0] = load;
    return sum;
  }

  double weight_;
  double load_share_;
  double gain_share_;  // [1/Pa]
  std::vector<rheology::ExponentialMemory> memories_;
  std::vector<rheology::ExponentialMemory::Step> steps_;  // of this scan
};

}  // namespace

EffectEntry creep() {
  EffectInfo info;
  info.id = "creep";
  info.summary = "rise under a constant load (data sheets: drift), and its fading";
  info.equation = "u = P_e + a sum_i (1 - exp(-t / tau_i)) * dP_e / 2, tau_i two a decade";
  info.source = "Tangio TPE-500 < 2 %, Interlink FSR 400 < 5 % per decade of time";
  info.stage = ChainStage::kMemory;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("per_decade", "a, change per decade of time", {0, 0.5, ""}, 0.03).within(0.003, 0.15),
      shape("fastest", "shortest time constant", {1e-3, 1e6, "s"}, 1).trying({0.1, 1, 10}),
      shape("slowest", "longest time constant", {1e-3, 1e6, "s"}, 1e4).trying({1e2, 1e3, 1e4}),
      shape("gain_share", "v, 0 = acts like load, 1 = on the sensitivity", {0, 1, ""}, 0).trying({0, 1}),
      shape("span", "P_span, load at which a creep of the sensitivity reaches a", {1e3, 10e6, "Pa"},
            kUsualRange)
          .ofRange(),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kTimeSinceReversal, Covariate::kDirection, Covariate::kPressure};
  info.needs = {Evidence::kTwoRampRates};
  info.collinear = {"hysteresis", "drift", "temperature", "seal_leak", "time_skew", "relaxation"};
  info.experiment = Experiment::kStepAndHold;
  info.mixture = true;
  info.also_called = "drift under constant load";
  return {info, makeEffect<Creep>};
}

// Under a constant load the reading falls, and it recovers when the load is gone.
//
//     u = P_e - R,   R = g / n sum_i J_i * dx,   x = P_s (P_e / P_s)^q,   J_i(t) = 1 - exp(-t / tau_i)
//
// This is quasi-linear viscoelasticity. x: elastic response [Pa]. Its reduced relaxation function is the
// Prony series G(t) = 1 - g + g / n sum_i exp(-t / tau_i). g: share of x that is lost in the end. There are
// two time constants tau_i a decade from the fastest to the slowest, n in all. They have the same weight,
// which approximates Fung's box spectrum. With one time constant this is the standard linear solid. q:
// exponent of the elastic response; with 1 the sheet is linearly viscoelastic. In cycles the reading is
// higher during loading than during unloading, unlike that of `hysteresis` and `creep`. `seal_leak` also
// makes a reading fall, but it acts on all taxels alike and has one time constant. Causes: layers, spacers
// and seals that take over part of the load as they settle, and fluid that flows out from under the taxels.
// Size: estimate. Source: Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, 2nd ed.,
// Springer 1993, ch. 7, doi:10.1007/978-1-4757-2257-4; W. N. Findley et al., Creep and Relaxation of
// Nonlinear Viscoelastic Materials, Dover 1989, ch. 5.

namespace {

constexpr double kRelaxationElements = 2;

std::vector<rheology::ExponentialMemory> relaxationElements(double fastest, double slowest) {
  if (slowest < fastest)
    throw settings::InputError("effects.relaxation: slowest must not be shorter than fastest");
  const long steps = std::lround(kRelaxationElements * std::log10(slowest / fastest));
  std::vector<rheology::ExponentialMemory> memories;
  for (long i = 0; i <= steps; ++i) {
    memories.emplace_back(fastest * std::pow(10, static_cast<double>(i) / kRelaxationElements));
  }
  return memories;
}

class Relaxation : public Effect {
 public:
  Relaxation(const EffectValues& values, const EffectContext& context)
      : exponent_(values.at("exponent")),
        span_(values.at("span")),
        memories_(relaxationElements(values.at("fastest"), values.at("slowest"))),
        steps_(memories_.size()),
        weight_(values.at("relaxed_share") / static_cast<double>(memories_.size())) {
    state_.assign(context.layout.size.taxels() * (1 + memories_.size()), 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    for (std::size_t k = 0; k < steps_.size(); ++k) steps_[k] = memories_[k].over(sample.elapsed);
    double* state = state_.data();  // of each taxel: x at the scan before, then the memories [Pa]
    for (double& load : signals.load) {
      load -= weight_ * advance(elasticResponse(load), state);
      state += 1 + steps_.size();
    }
  }

 private:
  double elasticResponse(double load) const {
    return exponent_ == 1 ? load : span_ * std::pow(std::max(load, 0.0) / span_, exponent_);
  }

  // Sum of a taxel's memories [Pa].
  double advance(double response, double* state) const {
    double sum = 0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      state[k + 1] = steps_[k](state[0], response, state[k + 1]);
      sum += state[k + 1];
    }
    state[0] = response;
    return sum;
  }

  double exponent_;
  double span_;  // [Pa]
  std::vector<rheology::ExponentialMemory> memories_;
  std::vector<rheology::ExponentialMemory::Step> steps_;  // of this scan
  double weight_;                                         // g / n
};

}  // namespace

EffectEntry relaxation() {
  EffectInfo info;
  info.id = "relaxation";
  info.summary = "fall under a constant load, and its recovery";
  info.equation = "u = P_e - g / n sum_i (1 - exp(-t / tau_i)) * dx, x = P_s (P_e / P_s)^q";
  info.source = "quasi-linear viscoelasticity, Fung 1993, ch. 7; size estimated";
  info.stage = ChainStage::kMemory;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("relaxed_share", "g, share of the load that is lost in the end", {0, 1, ""}, 0.05)
          .within(0.003, 0.5),
      shape("fastest", "shortest time constant", {1e-3, 1e6, "s"}, 1).trying({1, 10}),
      shape("slowest", "longest time constant", {1e-3, 1e6, "s"}, 1e3).trying({1e2, 1e3}),
      shape("exponent", "q, of the elastic response", {0.1, 4, ""}, 1),
      shape("span", "P_s, load at which the elastic response equals the load", {1e3, 10e6, "Pa"}, kUsualRange)
          .ofRange(),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kTimeSinceReversal, Covariate::kDirection, Covariate::kPressure};
  info.needs = {Evidence::kTwoRampRates};
  info.collinear = {"seal_leak", "creep", "hysteresis", "time_skew", "drift"};
  info.experiment = Experiment::kStepAndHold;
  info.mixture = true;
  return {info, makeEffect<Relaxation>};
}

}  // namespace fsr::simulation
