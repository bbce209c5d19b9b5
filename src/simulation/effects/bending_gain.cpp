// Bending changes the sensitivity of a taxel.
//
//     g = g (1 + b_i s(kappa) + c s(kappa) f_i(kappa)),   s = 1 - exp(-|kappa| / kg)
//
// kappa: principal curvature of the taxel [1/m]. b_i: change of the gain in a tight bend; it scatters from
// taxel to taxel. f_i: a smooth random function of the curvature for each taxel i, with standard deviation 1
// and correlation length l [1/m]. It lets surfaces differ from each other at random, as they do in
// Ahmadizadeh and Menon 2019. Both terms are zero on the flat.
// Size: gains of -10 to -23 % with a scatter of 3 % reproduce the tables of that paper (baseline against
// method 1). The form in kappa and the share that a concave bend has are assumptions.

#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"

namespace fsr::simulation {

namespace {

EffectInfo bendingGainInfo() {
  EffectInfo info;
  info.id = "bending_gain";
  info.summary = "sensitivity changed by bending: error at high pressure, by condition";
  info.equation = "g *= 1 + b s(kappa) + c s(kappa) f(kappa), s = 1 - exp(-|kappa| / kg)";
  info.source = "the paper's tables, -10 to -23 %, scatter 3 %";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("change", "b, change of gain in a tight bend", {-0.9, 1, ""}, -0.17)
          .within(-0.5, 0)
          .inBaseFit(7),
      shape("curvature_constant", "kg, curvature at which 63 % of b is there", {0.01, 1000, "1/m"}, 6)
          .trying({1, 6, 15})
          .inBaseFit(10),
      scatter("change_scatter", "deviation of b from taxel to taxel, relative", {0, 0.5, ""}, 0),
      scatter("scatter", "c, deviation of the gain from curvature to curvature", {0, 0.2, ""}, 0),
      shape("scatter_length", "l, curvature over which that scatter changes", {0.01, 1000, "1/m"}, 1.5),
      shape("concave_share", "share of b under a concave bend", {0, 1, ""}, 0.6),
  };
  info.sign = SignRule::kNegative;
  info.depends_on = {Covariate::kCurvature, Covariate::kPressure, Covariate::kTaxel};
  info.collinear = {"bending_preload", "repositioning"};
  info.experiment = Experiment::kFlatAgain;
  info.with_bending = true;
  return info;
}

class BendingGain : public Effect {
 public:
  BendingGain(const EffectValues& values, const EffectContext& context)
      : curvature_constant_(values.at("curvature_constant")),
        scatter_(values.at("scatter")),
        concave_share_(values.at("concave_share")),
        change_(scatteredValues(values.at("change"), values.at("change_scatter"), "bending_gain", context)),
        gain_(context.layout.size.taxels(), 1.0) {
    for (std::size_t i = 0; i < gain_.size(); ++i) {
      by_curvature_.emplace_back(values.at("scatter_length"), context.seed, "bending_gain.by_curvature", i);
    }
  }

  void mount(const Mounting& mounting) override {
    for (std::size_t i = 0; i < gain_.size(); ++i) gain_[i] = gain(i, mounting.curvature[i]);
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < gain_.size(); ++i) signals.gain[i] *= gain_[i];
  }

 private:
  double gain(std::size_t taxel, double curvature) const {
    const double shape = -std::expm1(-std::abs(curvature) / curvature_constant_);
    const double change = curvature < 0 ? concave_share_ * change_[taxel] : change_[taxel];
    return std::max(0.0, 1 + shape * (change + scatter_ * by_curvature_[taxel](curvature)));
  }

  double curvature_constant_;  // [1/m]
  double scatter_;
  double concave_share_;
  std::vector<double> change_;                      // [taxels]
  std::vector<SmoothRandomFunction> by_curvature_;  // [taxels]
  std::vector<double> gain_;                        // [taxels]
};

}  // namespace

EffectEntry bendingGain() {
  return {bendingGainInfo(), makeEffect<BendingGain>};
}

}  // namespace fsr::simulation
