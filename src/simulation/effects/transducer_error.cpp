// The pressure reference of the chamber has an error. Everything that is calibrated with it has the same
// error.
//
//     P_ref = P + e_0 + e_1 P + 4 e_2 P_span x (1 - x),   x = (P - P_low) / P_span   [Pa]
//
// e_0: offset. e_1: gain. e_2: bow, the largest distance from the straight line through both ends.
// Size: the Omega PX309 of Ahmadizadeh and Menon 2019 is within 0.25 % of its best straight line over -103
// to 1034 kPa (section 2.4), which is 2.8 kPa. The zero of a gauge transducer follows the weather by some
// kPa unless it is vented (estimate).

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr double kLow = -103e3;   // [Pa]
constexpr double kSpan = 1137e3;  // [Pa]

class TransducerError : public Effect {
 public:
  TransducerError(const EffectValues& values, const EffectContext&)
      : offset_(values.at("offset")), gain_(values.at("gain")), bow_(values.at("bow")) {}

  double transduce(double pressure) const override {
    const double x = (pressure - kLow) / kSpan;
    return pressure + (offset_ + gain_ * pressure + 4 * bow_ * kSpan * x * (1 - x));
  }

 private:
  double offset_;  // [Pa]
  double gain_;
  double bow_;
};

}  // namespace

EffectEntry transducerError() {
  EffectInfo info;
  info.id = "transducer_error";
  info.summary = "the pressure reference itself is off";
  info.equation = "P_ref = P + e_0 + e_1 P + 4 e_2 P_span x (1 - x)";
  info.source = "Omega PX309 in the paper: 0.25 % best straight line of 1137 kPa";
  info.stage = ChainStage::kReference;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {
      strength("offset", "e_0", {-20e3, 20e3, "Pa"}, 0).within(-5e3, 5e3),
      strength("gain", "e_1", {-0.2, 0.2, ""}, 0).within(-0.01, 0.01),
      strength("bow", "e_2, share of 1137 kPa", {-0.05, 0.05, ""}, 0.0025).within(-0.005, 0.005),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kPressure};
  info.needs = {Evidence::kSecondReference};
  info.collinear = {"static_curve", "trapped_gas"};
  info.experiment = Experiment::kSecondReference;
  return {info, makeEffect<TransducerError>};
}

}  // namespace fsr::simulation
