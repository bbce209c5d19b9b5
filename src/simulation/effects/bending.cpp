#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"

namespace fsr::simulation {

// Bending presses the layers of the sheet together before any gas pressure acts.
//
//     P_e = P_e + P0(kappa),   P0 = A (1 - exp(-kappa / k0)) + B kappa   [Pa]
//
// kappa: principal curvature of the taxel [1/m]. The saturating term is the spacer gap that closes. The
// linear term is the membrane tension T kappa of a stretched sheet (Laplace).
// Size: some 34 kPa on every cylinder reproduces the step between the flat and the bent sheets in Fig. 5 and
// the tables of Ahmadizadeh and Menon 2019. It is an assumption that a concave bend (kappa < 0) has the same
// effect, but a smaller one; nobody has published it for a matrix.

namespace {

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
  return {info, makeEffect<BendingPreload>};
}

// Up to some pressure a spacer keeps the layers apart. Bending closes the gap.
//
//     P_e = P_e - min(P_on, max(P_e, 0)),   P_on = P_0 exp(-|kappa| / k_on)   [Pa]
//
// For a load this is max(P_e - P_on, 0); suction is left unchanged.
// Size: 5 to 30 kPa, an estimate. For comparison: Tangio's TPE-500 needs 10 g (spacer of 0.05 mm) to 30 g
// (0.125 mm) on a finger-sized tip to reach 10 Mohm (data sheet v1.8, 2018), which is 4 to 12 kPa on its 5.6
// mm disc.

namespace {

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
  return {info, makeEffect<TurnOn>};
}

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

namespace {

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
  return {info, makeEffect<BendingGain>};
}

}  // namespace fsr::simulation
