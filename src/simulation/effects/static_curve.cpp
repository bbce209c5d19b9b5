// Conductance of a taxel under a steady load.
//
//     G = G0 + k g (max(u, 0) / P_ref)^n / (1 + (u / P_s)^n)   [S]
//
// The contact area grows with the load as a power n somewhat below 1 (rough contacts; R. Holm, Electric
// Contacts, 4th ed., Springer 1967) and saturates softly near P_s. Scatter between parts: Tangio TPE-500 4
// %, Interlink FSR 400 6 % (data sheets).

#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"

namespace fsr::simulation {

namespace {

class StaticCurve : public Effect {
 public:
  StaticCurve(const EffectValues& values, const EffectContext& context)
      : offset_(values.at("offset")),
        reference_(values.at("reference_pressure")),
        saturation_(reference_ / values.at("saturation_pressure")),
        conductance_(scatteredValues(values.at("conductance"), values.at("conductance_scatter"),
                                     "static_curve.conductance", context)),
        exponent_(scatteredValues(values.at("exponent"), values.at("exponent_scatter"),
                                  "static_curve.exponent", context)) {
    for (const double n : exponent_) saturation_share_.push_back(std::pow(saturation_, n));
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < conductance_.size(); ++i) {
      // (u / P_s)^n = (u / P_ref)^n (P_ref / P_s)^n: one power a taxel.
      const double load = signals.load[i] > 0 ? std::pow(signals.load[i] / reference_, exponent_[i]) : 0.0;
      signals.conductance[i] =
          offset_ + conductance_[i] * signals.gain[i] * load / (1 + load * saturation_share_[i]);
    }
  }

 private:
  double offset_;                         // [S]
  double reference_;                      // [Pa]
  double saturation_;                     // P_ref / P_s
  std::vector<double> conductance_;       // [taxels], S
  std::vector<double> exponent_;          // [taxels]
  std::vector<double> saturation_share_;  // [taxels], (P_ref / P_s)^n
};

}  // namespace

EffectEntry staticCurve() {
  EffectInfo info;
  info.id = "static_curve";
  info.summary = "conductance under a steady load, taxel by taxel";
  info.equation = "G = G0 + k g (max(u, 0) / P_ref)^n / (1 + (u / P_s)^n)";
  info.source = "power law of rough contacts (Holm) with soft saturation";
  info.stage = ChainStage::kConductance;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kBase;
  info.required = true;
  info.parameters = {
      shape("conductance", "k, at the reference pressure but for saturation", {1e-9, 1, "S"}, 3e-4)
          .inBaseFit(1),
      shape("reference_pressure", "P_ref", {1e3, 10e6, "Pa"}, 620e3),
      shape("exponent", "n", {0.2, 3, ""}, 0.9).within(0.5, 1.5).inBaseFit(2),
      shape("saturation_pressure", "P_s, .inf = none", {1e3, INFINITY, "Pa"}, 1.2e6)
          .offAt(INFINITY)
          .inBaseFit(3),
      strength("offset", "G0, unloaded", {0, 1, "S"}, 0).within(0, 1e-4).inBaseFit(4),
      scatter("conductance_scatter", "deviation of k from taxel to taxel, relative", {0, 0.5, ""}, 0.05)
          .fromTaxelDeviation(),
      scatter("exponent_scatter", "deviation of n from taxel to taxel, relative", {0, 0.2, ""}, 0),
  };
  info.depends_on = {Covariate::kPressure, Covariate::kTaxel};
  info.collinear = {"turn_on",      "trapped_gas", "edge_stiffness",  "crosstalk",
                    "supply_droop", "saturation",  "transducer_error"};
  return {info, makeEffect<StaticCurve>};
}

}  // namespace fsr::simulation
