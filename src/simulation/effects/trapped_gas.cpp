// A tight cavity keeps the gas that was in it when it was sealed. Pressing the sheet compresses this gas.
//
//     P_e = P - P_cav,   P_cav = p_a (1 / (1 - c x) - 1),   x = P / (P + P_h)   [Pa]
//
// This is Boyle's law at the ambient pressure p_a; the volume shrinks by the share c x. c: share of the
// volume that full pressure closes. P_h: pressure that closes half of that share. The form of x is an
// assumption for a stiff spacer under a soft sheet.

#include <algorithm>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr double kGasAmbient = 101325;  // [Pa]

EffectInfo trappedGasInfo() {
  EffectInfo info;
  info.id = "trapped_gas";
  info.summary = "sealed-in gas is squeezed and presses back";
  info.equation = "P_e = P - p_a (1 / (1 - c P / (P + P_h)) - 1)";
  info.source = "Boyle's law; the volume's dependence on pressure is an assumption";
  info.stage = ChainStage::kCavity;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("closing", "c, share of the cavity that closes", {0, 0.95, ""}, 0.3).within(0.02, 0.9),
      shape("half_pressure", "P_h, closes half of it", {1e3, 10e6, "Pa"}, 200e3).trying({5e4, 2e5, 8e5}),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kPressure};
  info.needs = {Evidence::kVentedSheet};
  info.collinear = {"static_curve", "transducer_error", "saturation"};
  info.experiment = Experiment::kVentedSheet;
  return info;
}

class TrappedGas : public Effect {
 public:
  TrappedGas(const EffectValues& values, const EffectContext&)
      : closing_(values.at("closing")), half_pressure_(values.at("half_pressure")) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    const double pressure = std::max(sample.pressure, 0.0);
    const double closed = closing_ * pressure / (pressure + half_pressure_);
    const double back = kGasAmbient * closed / (1 - closed);
    for (double& load : signals.load) load -= back;
  }

 private:
  double closing_;
  double half_pressure_;  // [Pa]
};

}  // namespace

EffectEntry trappedGas() {
  return {trappedGasInfo(), makeEffect<TrappedGas>};
}

}  // namespace fsr::simulation
