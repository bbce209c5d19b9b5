// Near its border a sealed sheet carries part of the load itself, or its rim concentrates the load.
//
//     P_e = P_e (1 + e exp(-d / L))   [Pa]
//
// d: distance of the taxel's centre from the nearest edge of the matrix [m]. L: length over which the effect
// decays [m]. e: a few per cent, negative where the rim carries load, positive where it concentrates load.
// Form and size are assumptions without data.

#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo edgeStiffnessInfo() {
  EffectInfo info;
  info.id = "edge_stiffness";
  info.summary = "taxels near the edge feel more or less of the load";
  info.equation = "P_e *= 1 + e exp(-d / L)";
  info.source = "assumption, a few per cent";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("change", "e, at the very edge", {-0.9, 2, ""}, -0.05).within(-0.2, 0.2),
      shape("length", "L, how far it reaches inwards", {1e-4, 1, "m"}, 0.01).trying({0.005, 0.01, 0.02}),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kTaxel, Covariate::kPressure};
  info.collinear = {"static_curve", "repositioning"};
  info.experiment = Experiment::kRemount;
  return info;
}

double distanceFromEdge(const matrix::Layout& layout, std::size_t taxel) {
  const matrix::Position place = layout.position({taxel});
  const double x = layout.size.columns * layout.pitch_x / 2 - std::abs(place.x);
  const double y = layout.size.rows * layout.pitch_y / 2 - std::abs(place.y);
  return std::min(x, y);
}

class EdgeStiffness : public Effect {
 public:
  EdgeStiffness(const EffectValues& values, const EffectContext& context) {
    for (std::size_t i = 0; i < context.layout.size.taxels(); ++i) {
      const double decay = std::exp(-distanceFromEdge(context.layout, i) / values.at("length"));
      factor_.push_back(1 + values.at("change") * decay);
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < factor_.size(); ++i) signals.load[i] *= factor_[i];
  }

 private:
  std::vector<double> factor_;  // [taxels]
};

}  // namespace

EffectEntry edgeStiffness() {
  return {edgeStiffnessInfo(), makeEffect<EdgeStiffness>};
}

}  // namespace fsr::simulation
