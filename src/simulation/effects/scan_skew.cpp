// A multiplexer reads one taxel after the other while the pressure changes.
//
//     taxel i of N, row-major, is read at t + (i - (N - 1) / 2) dt   [s]
//
// t: the stamp of the scan, which is its middle. dt: time from one taxel to the next [s].
// Size: 7 to 70 ms for 70 taxels (0.1 to 1 ms a taxel for settling of the amplifier and conversion by a
// common microcontroller; estimate).

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo scanSkewInfo() {
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
  return info;
}

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
  return {scanSkewInfo(), makeEffect<ScanSkew>};
}

}  // namespace fsr::simulation
