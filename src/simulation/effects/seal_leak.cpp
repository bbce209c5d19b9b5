// Gas leaks into the space behind the taxels and presses back, so that the sheet feels less and less of the
// chamber's pressure.
//
//     P_e = P - s P_cav,   dP_cav/dt = (P - P_cav) / tau   [Pa]
//
// s: share of the cavity of the sheet that the leak reaches, 1 = all. tau: time constant, from minutes to
// hours. After venting the cavity is still full and lifts the sheet. The effect is common to all taxels,
// because air channels connect them.
// Size: the sheet of Ahmadizadeh and Menon 2019 was sealed with PDMS (section 2.2), and the seal was not
// checked. tau is an estimate.

#include "rheology/exponential_memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo info() {
  EffectInfo info;
  info.id = "seal_leak";
  info.summary = "gas leaks behind the taxels: like creep, but downwards";
  info.equation = "P_e = P - s P_cav, dP_cav/dt = (P - P_cav) / tau";
  info.source = "gas through a small opening, linearised; minutes to hours, estimate";
  info.stage = ChainStage::kCavity;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("share", "s, share of the cavity that the leak reaches", {0, 1, ""}, 1).within(0.01, 1),
      shape("time_constant", "tau", {1, 1e6, "s"}, 1800).trying({60, 180, 600, 1800, 6000, 18000}),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kPressure, Covariate::kTimeSinceReversal, Covariate::kClockTime};
  info.collinear = {"creep", "drift", "hysteresis", "relaxation"};
  info.experiment = Experiment::kStepAndHold;
  info.mixture = true;
  return info;
}

class SealLeak : public Effect {
 public:
  SealLeak(const EffectValues& values, const EffectContext&)
      : share_(values.at("share")), leak_(values.at("time_constant")) {
    state_.assign(kState, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    state_[kCavity] = leak_.step(state_[kBefore], sample.pressure, sample.elapsed, state_[kCavity]);
    state_[kBefore] = sample.pressure;
    const double back = share_ * state_[kCavity];
    for (double& load : signals.load) load -= back;
  }

 private:
  enum { kBefore, kCavity, kState };  // chamber at the scan before, cavity [Pa]
  double share_;
  rheology::ExponentialMemory leak_;
};

}  // namespace

EffectEntry sealLeak() {
  return {info(), makeEffect<SealLeak>};
}

}  // namespace fsr::simulation
