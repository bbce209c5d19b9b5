// Bending presses the layers of the sheet together before any gas pressure acts.
//
//     P_e = P_e + P0(kappa),   P0 = A (1 - exp(-kappa / k0)) + B kappa   [Pa]
//
// kappa: principal curvature of the taxel [1/m]. The saturating term is the spacer gap that closes. The
// linear term is the membrane tension T kappa of a stretched sheet (Laplace).
// Size: some 34 kPa on every cylinder reproduces the step between the flat and the bent sheets in Fig. 5 and
// the tables of Ahmadizadeh and Menon 2019. It is an assumption that a concave bend (kappa < 0) has the same
// effect, but a smaller one; nobody has published it for a matrix.

#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"

namespace fsr::simulation {

namespace {

EffectInfo bendingPreloadInfo() {
  EffectInfo info;
  info.id = "bending_preload";
  info.summary = "standing load from bending: offset at low pressure, by condition";
  info.equation = "P_e += A (1 - exp(-kappa / k0)) + B kappa";
  info.source = "bending step of the paper's Fig. 5 and tables, 30 to 60 kPa";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("amplitude", "A, preload of a tight bend", {0, 300e3, "Pa"}, 34e3)
          .within(2e3, 150e3)
          .inBaseFit(5),
      strength("slope", "B, further preload by curvature", {0, 20e3, "Pa m"}, 0).within(0, 5e3),
      shape("curvature_constant", "k0, curvature at which 63 % of A is there", {0.01, 1000, "1/m"}, 3)
          .trying({1, 3, 10})
          .inBaseFit(6),
      scatter("scatter", "deviation from taxel to taxel, relative", {0, 0.5, ""}, 0),
      shape("concave_share", "share of it under a concave bend", {0, 1, ""}, 0.6),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kCurvature, Covariate::kPressure};
  info.collinear = {"turn_on", "bending_gain", "repositioning"};
  info.experiment = Experiment::kFlatAgain;
  info.with_bending = true;
  return info;
}

class BendingPreload : public Effect {
 public:
  BendingPreload(const EffectValues& values, const EffectContext& context)
      : amplitude_(values.at("amplitude")),
        curvature_constant_(values.at("curvature_constant")),
        slope_(values.at("slope")),
        concave_share_(values.at("concave_share")),
        scatter_(scatteredValues(1, values.at("scatter"), "bending_preload", context)),
        preload_(context.layout.size.taxels(), 0.0) {}

  void mount(const Mounting& mounting) override {
    for (std::size_t i = 0; i < preload_.size(); ++i) {
      preload_[i] = scatter_[i] * common(mounting.curvature[i]);
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < preload_.size(); ++i) signals.load[i] += preload_[i];
  }

 private:
  double common(double curvature) const {
    const double bend = std::abs(curvature);
    const double preload = -amplitude_ * std::expm1(-bend / curvature_constant_) + slope_ * bend;
    return curvature < 0 ? concave_share_ * preload : preload;
  }

  double amplitude_;           // [Pa]
  double curvature_constant_;  // [1/m]
  double slope_;               // [Pa m]
  double concave_share_;
  std::vector<double> scatter_;  // [taxels]
  std::vector<double> preload_;  // [taxels], Pa
};

}  // namespace

EffectEntry bendingPreload() {
  return {bendingPreloadInfo(), makeEffect<BendingPreload>};
}

}  // namespace fsr::simulation
