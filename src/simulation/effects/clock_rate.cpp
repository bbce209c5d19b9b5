// The clock that stamps the scans of the matrix runs faster or slower than the clock of the chamber.
//
//     y(t) is the reading of t' = (1 + e) t   [s]
//
// t: time since the first scan by the stamps of the matrix. t': the same instant by the clock of the chamber.
// At the first scan both clocks agree. With e > 0 the clock of the matrix runs slow. The delay of the stamps
// is -e t and grows without end; the delay of `time_skew` is constant.
// Size: 0.1 ms/s (100 ppm) for a quartz crystal, estimate. The internal RC oscillator of a microcontroller is
// within 10 %, or within 1 % after calibration by the user (Atmel data sheet ATmega48PA/88PA/168PA/328P,
// 8161D, 2009, table 28-1).

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo info() {
  EffectInfo info;
  info.id = "clock_rate";
  info.summary = "the clocks of matrix and chamber run at different rates";
  info.equation = "y(t) = y_0((1 + e) t), t from the first scan";
  info.source = "quartz 100 ppm, estimate; RC oscillator 1 to 10 % (Atmel 8161D, table 28-1)";
  info.stage = ChainStage::kTiming;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {
      strength("rate", "e, loss of the matrix's clock", {-0.1, 0.1, "s/s"}, 1e-4).within(-0.01, 0.01)};
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kPressureRate, Covariate::kDirection, Covariate::kClockTime};
  info.collinear = {"time_skew"};
  info.experiment = Experiment::kManyCycles;
  info.looked_for = false;
  return info;
}

class ClockRate : public Effect {
 public:
  ClockRate(const EffectValues& values, const EffectContext&) : rate_(values.at("rate")) {
    state_.assign(1, 0.0);  // time of the first scan [s]
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (sample.first) state_[0] = sample.time;
    signals.skew -= rate_ * (sample.time - state_[0]);
  }

 private:
  double rate_;
};

}  // namespace

EffectEntry clockRate() {
  return {info(), makeEffect<ClockRate>};
}

}  // namespace fsr::simulation
