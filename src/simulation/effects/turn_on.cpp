// Up to some pressure a spacer keeps the layers apart. Bending closes the gap.
//
//     P_e = P_e - min(P_on, max(P_e, 0)),   P_on = P_0 exp(-|kappa| / k_on)   [Pa]
//
// For a load this is max(P_e - P_on, 0); suction is left unchanged.
// Size: 5 to 30 kPa, an estimate. For comparison: Tangio's TPE-500 needs 10 g (spacer of 0.05 mm) to 30 g
// (0.125 mm) on a finger-sized tip to reach 10 Mohm (data sheet v1.8, 2018), which is 4 to 12 kPa on its 5.6
// mm disc.

#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"

namespace fsr::simulation {

namespace {

EffectInfo turnOnInfo() {
  EffectInfo info;
  info.id = "turn_on";
  info.summary = "nothing is read below a pressure, which bending lowers";
  info.equation = "P_e = max(P_e - P_0 exp(-|kappa| / k_on), 0)";
  info.source = "estimate, 5 to 30 kPa; Tangio TPE-500: 10 to 30 g on a 5.6 mm disc";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("pressure", "P_0, on the flat", {0, 200e3, "Pa"}, 10e3).within(1e3, 60e3),
      shape("curvature_constant", "k_on, curvature that leaves 37 % of it", {0.01, 1000, "1/m"}, 10)
          .trying({3, 10, 30}),
      scatter("scatter", "deviation from taxel to taxel, relative", {0, 1, ""}, 0),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kPressure, Covariate::kCurvature};
  info.collinear = {"bending_preload", "static_curve"};
  info.experiment = Experiment::kSlowStart;
  return info;
}

class TurnOn : public Effect {
 public:
  TurnOn(const EffectValues& values, const EffectContext& context)
      : curvature_constant_(values.at("curvature_constant")),
        flat_(scatteredValues(values.at("pressure"), values.at("scatter"), "turn_on", context)),
        pressure_(flat_) {}

  void mount(const Mounting& mounting) override {
    for (std::size_t i = 0; i < flat_.size(); ++i) {
      pressure_[i] = flat_[i] * std::exp(-std::abs(mounting.curvature[i]) / curvature_constant_);
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < pressure_.size(); ++i) {
      signals.load[i] -= std::min(pressure_[i], std::max(signals.load[i], 0.0));
    }
  }

 private:
  double curvature_constant_;     // [1/m]
  std::vector<double> flat_;      // [taxels], Pa
  std::vector<double> pressure_;  // [taxels], Pa
};

}  // namespace

EffectEntry turnOn() {
  return {turnOnInfo(), makeEffect<TurnOn>};
}

}  // namespace fsr::simulation
