// Gas leaks into the space behind the taxels and presses back, so that the sheet feels less and less of the
// chamber's pressure.
//
//     P_e = P - s P_cav,   dP_cav/dt = (1 - q) (P - P_cav) / tau +- q (1 - b) p_1 psi(p_2 / p_1) / tau   [Pa]
//     psi(r) = 1 where r <= b, else sqrt(1 - ((r - b) / (1 - b))^2)
//
// s: share of the cavity of the sheet that the leak reaches, 1 = all. tau: time constant, from minutes to
// hours. After venting the cavity is still full and lifts the sheet. The effect is common to all taxels,
// because air channels connect them.
// q: share of the leak that flows through an orifice. The rest is laminar and proportional to the difference
// of the pressures. p_1, p_2: absolute pressures before and behind the orifice; the sign is + while gas flows
// into the cavity. Below the critical ratio p_2 / p_1 = b the flow is choked: it depends on p_1 alone. The
// orifice is so large that its choked flow is (1 - b) p_1 / tau, which is the laminar flow at the critical
// ratio. A cavity fills through it in a finite time, and completely. Temperature and volume of the gas in the
// cavity are constant.
// Source of psi: ISO 6358-1:2013. b is 0.528 for an ideal nozzle and air, and 0.2 to 0.5 for real
// restrictions. Size: the sheet of Ahmadizadeh and Menon 2019 was sealed with PDMS (section 2.2), and the
// seal was not checked. tau is an estimate.

#include <algorithm>
#include <cmath>

#include "rheology/exponential_memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr double kLeakAmbient = 101325;  // [Pa]

EffectInfo sealLeakInfo() {
  EffectInfo info;
  info.id = "seal_leak";
  info.summary = "gas leaks behind the taxels: like creep, but downwards";
  info.equation = "P_e = P - s P_cav, dP_cav/dt = (P - P_cav) / tau, or +- (1 - b) p_1 psi(p_2 / p_1) / tau";
  info.source = "laminar leak, or orifice with choked flow (ISO 6358-1:2013); minutes to hours, estimate";
  info.stage = ChainStage::kCavity;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("share", "s, share of the cavity that the leak reaches", {0, 1, ""}, 1).within(0.01, 1),
      shape("time_constant", "tau", {1, 1e6, "s"}, 1800).trying({60, 180, 600, 1800, 6000, 18000}),
      shape("orifice_share", "q, 0 = laminar leak, 1 = orifice with choked flow", {0, 1, ""}, 0)
          .offAt(0)
          .trying({0, 1}),
      shape("critical_ratio", "b, absolute pressure ratio below which the flow is choked", {0.05, 0.95, ""},
            0.528)
          .within(0.2, 0.528),
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
      : share_(values.at("share")),
        orifice_share_(values.at("orifice_share")),
        critical_ratio_(values.at("critical_ratio")),
        leak_(values.at("time_constant")) {
    state_.assign(kState, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    state_[kCavity] = orifice_share_ == 0
                          ? leak_.step(state_[kBefore], sample.pressure, sample.elapsed, state_[kCavity])
                          : fill(state_[kBefore], sample.pressure, sample.elapsed, state_[kCavity]);
    state_[kBefore] = sample.pressure;
    const double back = share_ * state_[kCavity];
    for (double& load : signals.load) load -= back;
  }

 private:
  enum { kBefore, kCavity, kState };  // chamber at the scan before, cavity [Pa]

  // Rate at which the orifice raises the pressure of the cavity, times tau [Pa].
  double orificeFlow(double chamber, double cavity) const {
    const double upstream = std::max(chamber, cavity) + kLeakAmbient;
    if (upstream <= 0 || chamber == cavity) return 0;
    const double ratio = std::max(std::min(chamber, cavity) + kLeakAmbient, 0.0) / upstream;
    const double beyond = (ratio - critical_ratio_) / (1 - critical_ratio_);
    const double psi = beyond <= 0 ? 1 : std::sqrt(1 - beyond * beyond);
    return std::copysign((1 - critical_ratio_) * upstream * psi, chamber - cavity);
  }

  double rate(double chamber, double cavity) const {
    const double laminar = chamber - cavity;
    return ((1 - orifice_share_) * laminar + orifice_share_ * orificeFlow(chamber, cavity)) /
           leak_.timeConstant();
  }

  // Pressure of the cavity [Pa] after the chamber has changed linearly within `duration` [s], by the method
  // of Runge and Kutta of fourth order. Where a step passes the pressure of the chamber, the cavity has
  // reached it.
  double fill(double from, double to, double duration, double cavity) const {
    if (duration <= 0) return cavity;
    constexpr double kStepsPerTimeConstant = 50, kMostSteps = 2000;
    const double steps =
        std::clamp(std::ceil(duration / leak_.timeConstant() * kStepsPerTimeConstant), 1.0, kMostSteps);
    const double step = duration / steps;
    for (double i = 0; i < steps; ++i) {
      const double begin = from + (to - from) * i / steps, end = from + (to - from) * (i + 1) / steps;
      const double middle = 0.5 * (begin + end);
      const double k1 = rate(begin, cavity), k2 = rate(middle, cavity + 0.5 * step * k1);
      const double k3 = rate(middle, cavity + 0.5 * step * k2), k4 = rate(end, cavity + step * k3);
      const double next = cavity + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      cavity = (end - cavity) * (end - next) < 0 ? end : next;
    }
    return cavity;
  }

  double share_;
  double orifice_share_;
  double critical_ratio_;
  rheology::ExponentialMemory leak_;
};

}  // namespace

EffectEntry sealLeak() {
  return {sealLeakInfo(), makeEffect<SealLeak>};
}

}  // namespace fsr::simulation
