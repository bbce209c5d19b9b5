// The voltage that drives the matrix falls when much of the sheet is loaded.
//
//     G_i = G_i (1 - r sum_k G_k)   [S]
//
// r: internal resistance of the supply that drives the matrix [ohm]. The reference of the converter stays
// constant.
// Size: less than 1 %; 0.3 ohm and 70 taxels of 0.2 mS make 0.4 % (estimate).

#include <algorithm>
#include <numeric>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo supplyDroopInfo() {
  EffectInfo info;
  info.id = "supply_droop";
  info.summary = "the driving voltage sinks with the total load";
  info.equation = "G_i *= 1 - r sum_k G_k";
  info.source = "estimate, below 1 %";
  info.stage = ChainStage::kReadOut;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {strength("resistance", "r", {0, 1000, "ohm"}, 0.3).within(0.05, 5)};
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kTotalLoad};
  info.needs = {Evidence::kUnevenLoad};
  info.collinear = {"static_curve", "crosstalk"};
  info.experiment = Experiment::kUnevenLoad;
  return info;
}

class SupplyDroop : public Effect {
 public:
  SupplyDroop(const EffectValues& values, const EffectContext&) : resistance_(values.at("resistance")) {}

  void apply(const RigSample&, TaxelSignals& signals) override {
    auto& conductance = signals.conductance;
    const double total = std::accumulate(conductance.begin(), conductance.end(), 0.0);
    const double left = std::max(0.0, 1 - resistance_ * total);
    for (double& value : conductance) value *= left;
  }

 private:
  double resistance_;  // [ohm]
};

}  // namespace

EffectEntry supplyDroop() {
  return {supplyDroopInfo(), makeEffect<SupplyDroop>};
}

}  // namespace fsr::simulation
