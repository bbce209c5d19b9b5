#include <algorithm>
#include <cmath>

#include "rheology/memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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

namespace {

constexpr double kLeakAmbient = 101325;  // [Pa]

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
  info.collinear = {"creep", "drift", "hysteresis", "relaxation", "temperature"};
  info.experiment = Experiment::kStepAndHold;
  info.mixture = true;
  return {info, makeEffect<SealLeak>};
}

// A tight cavity keeps the gas that was in it when it was sealed. Pressing the sheet compresses this gas.
//
//     P_e = P - P_cav,   P_cav = p_a (1 / (1 - c x) - 1),   x = P / (P + P_h)   [Pa]
//
// This is Boyle's law at the ambient pressure p_a; the volume shrinks by the share c x. c: share of the
// volume that full pressure closes. P_h: pressure that closes half of that share. The form of x is an
// assumption for a stiff spacer under a soft sheet.

namespace {

constexpr double kGasAmbient = 101325;  // [Pa]

class TrappedGas : public Effect {
 public:
  TrappedGas(const EffectValues& values, const EffectContext&)
      : closing_(values.at("closing")), half_pressure_(values.at("half_pressure")) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    const double pressure = std::max(sample.pressure, 0.0);
    const double closed = closing_ * pressure / (pressure + half_pressure_);
    const double back = kGasAmbient * closed / (1 - closed);
    for (double& load : signals.load) load -= back;
  }

 private:
  double closing_;
  double half_pressure_;  // [Pa]
};

}  // namespace

EffectEntry trappedGas() {
  EffectInfo info;
  info.id = "trapped_gas";
  info.summary = "sealed-in gas is squeezed and presses back";
  info.equation = "P_e = P - p_a (1 / (1 - c P / (P + P_h)) - 1)";
  info.source = "Boyle's law; the volume's dependence on pressure is an assumption";
  info.stage = ChainStage::kCavity;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("closing", "c, share of the cavity that closes", {0, 0.95, ""}, 0.3).within(0.02, 0.9),
      shape("half_pressure", "P_h, closes half of it", {1e3, 10e6, "Pa"}, 200e3).trying({5e4, 2e5, 8e5}),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kPressure};
  info.needs = {Evidence::kVentedSheet};
  info.collinear = {"static_curve", "transducer_error", "saturation"};
  info.experiment = Experiment::kVentedSheet;
  return {info, makeEffect<TrappedGas>};
}

}  // namespace fsr::simulation
