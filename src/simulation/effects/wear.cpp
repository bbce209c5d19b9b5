// Millions of cycles wear the layers.
//
//     g = g (1 - c ((N_a + N) / 10^7)^m),   N = W / (2 P_span),   W = sum |dP|
//
// W: path length of the pressure [Pa]. N_a: cycles of the sheet before the simulation begins.
// Size: 7 % after 10 million actuations (Tangio TPE-500 v1.8, 2018, no sign given); resistance -10 %
// (Interlink FSR 400 PDS-10004-C: there the reading rises, c is negative). With m = 0.26 that is 0.3 % in
// the 60 cycles of Ahmadizadeh and Menon 2019, and 2 % within 10^5. The form is an assumption.

#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr double kLifetime = 1e7;  // [cycles]

EffectInfo info() {
  EffectInfo info;
  info.id = "wear";
  info.summary = "sensitivity lost, or won, over millions of cycles";
  info.equation = "g *= 1 - c ((N_a + N) / 1e7)^m";
  info.source = "Tangio TPE-500 7 %, Interlink FSR 400 -10 % of resistance in 10 million";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("loss", "c, in 10 million cycles", {-0.5, 0.9, ""}, 0.07).within(-0.2, 0.3),
      shape("exponent", "m", {0.05, 2, ""}, 0.26).trying({0.26, 0.5, 1}),
      shape("age", "N_a, cycles before the simulation begins", {0, 1e9, "cycles"}, 0),
      shape("span", "P_span, peak of a whole cycle", {1e3, 10e6, "Pa"}, 620e3),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kAccumulatedChange, Covariate::kCycle, Covariate::kPressure};
  info.needs = {Evidence::kManyCycles, Evidence::kThermometer};
  info.collinear = {"drift", "break_in", "temperature"};
  info.experiment = Experiment::kManyCycles;
  info.slow = true;
  return info;
}

class Wear : public Effect {
 public:
  Wear(const EffectValues& values, const EffectContext&)
      : loss_(values.at("loss")),
        exponent_(values.at("exponent")),
        age_(values.at("age")),
        cycle_(2 * values.at("span")) {
    state_.assign(kState, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (!sample.first) state_[kPathLength] += std::abs(sample.pressure - state_[kBefore]);
    state_[kBefore] = sample.pressure;
    const double worn = std::pow((age_ + state_[kPathLength] / cycle_) / kLifetime, exponent_);
    const double factor = std::max(0.0, 1 - loss_ * worn);
    for (double& gain : signals.gain) gain *= factor;
  }

 private:
  enum { kBefore, kPathLength, kState };  // chamber at the scan before, W [Pa]
  double loss_;
  double exponent_;
  double age_;    // [cycles]
  double cycle_;  // path length of the pressure in a whole cycle [Pa]
};

}  // namespace

EffectEntry wear() {
  return {info(), makeEffect<Wear>};
}

}  // namespace fsr::simulation
