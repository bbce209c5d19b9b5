// The conductance of the ink depends on temperature.
//
//     g = g exp(a x + b (T - T_0)^2),   x = T_0^2 (1 / T_0 - 1 / T)   [K]
//     P_e = P_e + z (T_z - T_0)
//
// This is thermally activated conduction (Arrhenius), written with its slope a = E_a / (k T_0^2) at T_0; a
// (T - T_0) is its linear form. Both signs of a occur. T_0: temperature at which the sensitivity is nominal
// and the zero is not shifted. T: temperature of the sheet, which follows that of the gas with the time
// constant tau. At the first scan it is s above that of the gas. z: shift of the zero with temperature,
// called thermal zero shift in data sheets of pressure transducers. It acts like load, because layers that
// expand differently press on each other. Its temperature T_z follows the gas with a time constant of its
// own. Size: 0.25 to 0.36 % a kelvin (0.36 %: FlexiForce A201, from memory, not verified). The data sheet of
// Interlink FSR 400 (PDS-10004-C) states a resistance of -5 % after an hour at -40 and -15 % at +85 degree
// Celsius. It falls at both ends, which needs b. No figure is published for z; 100 Pa/K is an estimate.

#include <cmath>

#include "rheology/memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr double kZeroCelsius = 273.15;  // [K]

class Temperature : public Effect {
 public:
  Temperature(const EffectValues& values, const EffectContext&)
      : coefficient_(values.at("coefficient")),
        quadratic_(values.at("quadratic")),
        reference_(values.at("reference")),
        start_(values.at("start")),
        zero_shift_(values.at("zero_shift")),
        sheet_(values.at("lag")),
        zero_(values.at("zero_lag")) {
    state_.assign(zero_shift_ == 0 ? std::size_t{kWithoutZero} : std::size_t{kState}, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    const double gas = sample.temperature - reference_;
    if (sample.first) {
      state_[kBefore] = gas;
      state_[kSheet] = gas + start_;
    }
    state_[kSheet] = sheet_.step(state_[kBefore], gas, sample.elapsed, state_[kSheet]);
    if (zero_shift_ != 0) shiftZero(sample, gas, signals);
    state_[kBefore] = gas;
    const double factor = gain(state_[kSheet]);
    for (double& gain : signals.gain) gain *= factor;
  }

 private:
  // Gas at the scan before, sheet, T_z, all above T_0 [K].
  enum { kBefore, kSheet, kZero, kState };
  static constexpr std::size_t kWithoutZero = kZero;

  void shiftZero(const RigSample& sample, double gas, TaxelSignals& signals) {
    if (sample.first) state_[kZero] = gas + start_;
    state_[kZero] = zero_.step(state_[kBefore], gas, sample.elapsed, state_[kZero]);
    const double shift = zero_shift_ * state_[kZero];
    for (double& load : signals.load) load += shift;
  }

  double gain(double above) const {
    const double reference = reference_ + kZeroCelsius;
    const double activated = above * reference / (reference + above);  // x
    return std::exp(coefficient_ * activated + quadratic_ * above * above);
  }

  double coefficient_;  // [1/K]
  double quadratic_;    // [1/K^2]
  double reference_;    // [degree Celsius]
  double start_;        // [K]
  double zero_shift_;   // [Pa/K]
  rheology::ExponentialMemory sheet_;
  rheology::ExponentialMemory zero_;
};

}  // namespace

EffectEntry temperature() {
  EffectInfo info;
  info.id = "temperature";
  info.summary = "sensitivity changed by temperature, with a lag";
  info.equation = "g *= exp(a T_0^2 (1 / T_0 - 1 / T) + b (T - T_0)^2), P_e += z (T_z - T_0)";
  info.source = "Arrhenius; FlexiForce A201 0.36 % a kelvin (not verified), Interlink FSR 400";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("coefficient", "a, relative change", {-0.05, 0.05, "1/K"}, 0.003).within(-0.01, 0.01),
      strength("quadratic", "b, relative change", {-0.001, 0.001, "1/K^2"}, 0).within(-1e-4, 1e-4),
      shape("lag", "tau, time constant of the sheet behind the gas", {0.01, 1e5, "s"}, 60)
          .trying({1, 10, 60, 300, 1000}),
      // Not tried: another reference only moves a part of b to a, and the course of the start is that of
      // drift.
      shape("reference", "T_0, where the sensitivity is nominal", {-40, 125, "degree Celsius"},
            kRoomTemperature)
          .offAt(kRoomTemperature),
      shape("start", "s, temperature of the sheet above the gas at the first scan", {-50, 50, "K"}, 0)
          .offAt(0),
      strength("zero_shift", "z, shift of the zero that acts like load", {-10e3, 10e3, "Pa/K"}, 0)
          .within(-1e3, 1e3),
      shape("zero_lag", "time constant of T_z behind the gas", {0.01, 1e5, "s"}, 60).trying({1, 60, 1000}),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kTemperature, Covariate::kClockTime};
  info.needs = {Evidence::kThermometer};
  info.collinear = {"drift", "creep", "wear", "break_in", "seal_leak", "repositioning"};
  info.experiment = Experiment::kTwoAmbients;
  info.slow = true;
  return {info, makeEffect<Temperature>};
}

}  // namespace fsr::simulation
