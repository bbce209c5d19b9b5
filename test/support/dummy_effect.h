#pragma once

#include <cmath>

#include "simulation/effects/effect_library.h"

namespace test_support {

/// An effect that is not part of the package: the sensitivity changes with the rate of the pressure.
///
///     g = g (1 + a r / (|r| + r_0)),   r = dP/dt   [Pa/s]
class RateGain : public fsr::simulation::Effect {
 public:
  RateGain(const fsr::simulation::EffectValues& values, const fsr::simulation::EffectContext&)
      : change_(values.at("change")), rate_(values.at("rate")) {
    state_.assign(1, 0.0);  // pressure at the scan before [Pa]
  }

  void apply(const fsr::simulation::RigSample& sample, fsr::simulation::TaxelSignals& signals) override {
    const double rate = sample.elapsed > 0 ? (sample.pressure - state_[0]) / sample.elapsed : 0;
    state_[0] = sample.pressure;
    for (double& gain : signals.gain) gain *= 1 + change_ * rate / (std::abs(rate) + rate_);
  }

 private:
  double change_;
  double rate_;  // [Pa/s]
};

inline fsr::simulation::EffectEntry rateGain() {
  using namespace fsr::simulation;
  EffectInfo info;
  info.id = "rate_gain";
  info.summary = "sensitivity changed by the rate of the pressure";
  info.equation = "g *= 1 + a r / (|r| + r_0), r = dP/dt";
  info.source = "none: for tests";
  info.stage = ChainStage::kGain;
  info.kind = EffectKind::kAdditive;
  info.parameters = {strength("change", "a", {-0.5, 0.5, ""}, 0.05).within(-0.2, 0.2),
                     shape("rate", "r_0", {1, 1e6, "Pa/s"}, 10e3)};
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kPressureRate, Covariate::kDirection, Covariate::kPressure};
  info.experiment = Experiment::kTwoRampRates;
  return {info, makeEffect<RateGain>};
}

/// The effects of the package and this one.
inline std::shared_ptr<const fsr::simulation::EffectLibrary> libraryWithRateGain() {
  return fsr::simulation::EffectLibrary::shipped().with(rateGain());
}

}  // namespace test_support
