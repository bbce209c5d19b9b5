#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

// The stamps of the matrix and those of the chamber come from two clocks.
//
//     y(t) is the reading of t - d + e (t - t_1)   [s]
//
// d is one delay for the whole matrix. Causes: a board or driver that stamps a scan on arrival, a transducer
// behind a filter, two computers. e: relative difference of the rates of the two clocks. t_1: the first scan,
// at which e has not acted yet. With e > 0 the clock of the matrix runs slow, and the delay falls without
// end. Size: at 17 kPa/s, 0.1 s is 1.7 kPa, 0.27 % of 620 kPa. Ahmadizadeh and Menon 2019 say that both were
// synchronised in LabVIEW, but not how well. The range is an estimate: two clocks that were set by hand
// differ by seconds. e is 0.1 ms/s (100 ppm) for a quartz crystal, estimate. The internal RC oscillator of a
// microcontroller is within 10 %, or within 1 % after calibration by the user (Atmel data sheet
// ATmega48PA/88PA/168PA/328P, 8161D, 2009, table 28-1).

namespace {

class TimeSkew : public Effect {
 public:
  TimeSkew(const EffectValues& values, const EffectContext&)
      : delay_(values.at("delay")), rate_(values.at("rate")) {
    if (rate_ != 0) state_.assign(1, 0.0);  // t_1 [s]
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    signals.skew += delay_;
    if (rate_ == 0) return;
    if (sample.first) state_[0] = sample.time;
    signals.skew -= rate_ * (sample.time - state_[0]);
  }

 private:
  double delay_;  // [s]
  double rate_;
};

}  // namespace

EffectEntry timeSkew() {
  EffectInfo info;
  info.id = "time_skew";
  info.summary = "the matrix's stamps are late or early by one delay";
  info.equation = "y(t) = y_0(t - d + e (t - t_1))";
  info.source = "estimate; 0.1 s is 0.27 % of full scale at 17 kPa/s";
  info.stage = ChainStage::kTiming;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {
      strength("delay", "d, stamps are late by", {-60, 60, "s"}, 0.1).within(-10, 10),
      strength("rate", "e, loss of the matrix's clock", {-0.1, 0.1, "s/s"}, 0).within(-0.01, 0.01),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kPressureRate, Covariate::kDirection, Covariate::kClockTime};
  info.needs = {Evidence::kTwoRampRates};
  info.collinear = {"hysteresis", "creep", "scan_skew", "relaxation"};
  info.constant = true;
  info.if_negative =
      "The matrix is ahead of the chamber pressure: check the clocks. A viscous damper reads alike.";
  info.experiment = Experiment::kTwoRampRates;
  return {info, makeEffect<TimeSkew>};
}

// A multiplexer reads one taxel after the other while the pressure changes.
//
//     taxel i of N, row-major, is read at t + (i - (N - 1) / 2) dt   [s]
//
// t: the stamp of the scan, which is its middle. dt: time from one taxel to the next [s].
// Size: 7 to 70 ms for 70 taxels (0.1 to 1 ms a taxel for settling of the amplifier and conversion by a
// common microcontroller; estimate).

namespace {

class ScanSkew : public Effect {
 public:
  ScanSkew(const EffectValues& values, const EffectContext&) : taxel_time_(values.at("taxel_time")) {}

  void apply(const RigSample&, TaxelSignals& signals) override {
    const double middle = (static_cast<double>(signals.offset.size()) - 1) / 2;
    for (std::size_t i = 0; i < signals.offset.size(); ++i) {
      signals.offset[i] += (static_cast<double>(i) - middle) * taxel_time_;
    }
  }

 private:
  double taxel_time_;  // [s]
};

}  // namespace

EffectEntry scanSkew() {
  EffectInfo info;
  info.id = "scan_skew";
  info.summary = "taxels of one scan are read one after the other";
  info.equation = "y_i(t) = y_0i(t + (i - (N - 1) / 2) dt)";
  info.source = "estimate; 7 to 70 ms for a scan of 70 taxels";
  info.stage = ChainStage::kTiming;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {
      strength("taxel_time", "dt, from one taxel to the next", {-0.1, 0.1, "s"}, 5e-4).within(5e-6, 2e-3)};
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kPressureRate, Covariate::kRow, Covariate::kTaxel};
  info.collinear = {"time_skew"};
  info.experiment = Experiment::kTwoRampRates;
  info.looked_for = false;
  return {info, makeEffect<ScanSkew>};
}

}  // namespace fsr::simulation
