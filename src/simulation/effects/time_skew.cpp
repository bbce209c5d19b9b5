// The stamps of the matrix and those of the chamber come from two clocks.
//
//     y(t) is the reading of t - d   [s]
//
// d is one delay for the whole matrix. Causes: a board or driver that stamps a scan on arrival, a transducer
// behind a filter, two computers.
// Size: at 17 kPa/s, 0.1 s is 1.7 kPa, 0.27 % of 620 kPa. Ahmadizadeh and Menon 2019 say that both were
// synchronised in LabVIEW, but not how well. The range is an estimate.

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo info() {
  EffectInfo info;
  info.id = "time_skew";
  info.summary = "the matrix's stamps are late or early by one delay";
  info.equation = "y(t) = y_0(t - d)";
  info.source = "estimate; 0.1 s is 0.27 % of full scale at 17 kPa/s";
  info.stage = ChainStage::kTiming;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {strength("delay", "d, stamps are late by", {-60, 60, "s"}, 0.1).within(-1, 1)};
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kPressureRate, Covariate::kDirection};
  info.collinear = {"hysteresis", "creep", "scan_skew", "clock_rate", "relaxation"};
  info.experiment = Experiment::kTwoRampRates;
  return info;
}

class TimeSkew : public Effect {
 public:
  TimeSkew(const EffectValues& values, const EffectContext&) : delay_(values.at("delay")) {}

  void apply(const RigSample&, TaxelSignals& signals) override { signals.skew += delay_; }

 private:
  double delay_;  // [s]
};

}  // namespace

EffectEntry timeSkew() {
  return {info(), makeEffect<TimeSkew>};
}

}  // namespace fsr::simulation
