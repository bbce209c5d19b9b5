// The conductance of the ink depends on temperature.
//
//     g = g exp(a x + b (T - T_0)^2),   x = T_0^2 (1 / T_0 - 1 / T)   [K],   T_0 = 23 degree Celsius
//
// This is thermally activated conduction (Arrhenius), written with its slope a = E_a / (k T_0^2) at T_0; a
// (T - T_0) is its linear form. The temperature of the sheet follows that of the gas with the time constant
// tau. Both signs occur.
// Size: 0.25 to 0.36 % a kelvin (0.36 %: FlexiForce A201, from memory, not verified). The data sheet of
// Interlink FSR 400 (PDS-10004-C) states a resistance of -5 % after an hour at -40 and -15 % at +85 degree
// Celsius. It falls at both ends, which needs b.

#include <cmath>

#include "rheology/exponential_memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr double kZeroCelsius = 273.15;  // [K]

EffectInfo info() {
  EffectInfo info;
  info.id = "temperature";
  info.summary = "sensitivity changed by temperature, with a lag";
  info.equation = "g *= exp(a T_0^2 (1 / T_0 - 1 / T) + b (T - T_0)^2), T lags by tau";
  info.source = "Arrhenius; FlexiForce A201 0.36 % a kelvin (not verified), Interlink FSR 400";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("coefficient", "a, relative change", {-0.05, 0.05, "1/K"}, 0.003).within(-0.01, 0.01),
      strength("quadratic", "b, relative change", {-0.001, 0.001, "1/K^2"}, 0).within(-1e-4, 1e-4),
      shape("lag", "tau, time constant of the sheet behind the gas", {0.01, 1e5, "s"}, 60)
          .trying({1, 10, 60, 300, 1000}),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kTemperature, Covariate::kClockTime};
  info.needs = {Evidence::kThermometer};
  info.collinear = {"drift", "creep", "wear", "break_in"};
  info.experiment = Experiment::kTwoAmbients;
  info.slow = true;
  return info;
}

class Temperature : public Effect {
 public:
  Temperature(const EffectValues& values, const EffectContext&)
      : coefficient_(values.at("coefficient")), quadratic_(values.at("quadratic")), sheet_(values.at("lag")) {
    state_.assign(kState, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    const double gas = sample.temperature - kRoomTemperature;
    if (sample.first) state_[kSheet] = state_[kBefore] = gas;  // it lay there long enough
    state_[kSheet] = sheet_.step(state_[kBefore], gas, sample.elapsed, state_[kSheet]);
    state_[kBefore] = gas;
    const double factor = gain(state_[kSheet]);
    for (double& gain : signals.gain) gain *= factor;
  }

 private:
  enum { kBefore, kSheet, kState };  // gas at the scan before, sheet, both above T_0 [K]

  double gain(double above) const {
    const double reference = kRoomTemperature + kZeroCelsius;
    const double activated = above * reference / (reference + above);  // x
    return std::exp(coefficient_ * activated + quadratic_ * above * above);
  }

  double coefficient_;  // [1/K]
  double quadratic_;    // [1/K^2]
  rheology::ExponentialMemory sheet_;
};

}  // namespace

EffectEntry temperature() {
  return {info(), makeEffect<Temperature>};
}

}  // namespace fsr::simulation
