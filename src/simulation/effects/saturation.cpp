// The amplifier reaches its voltage limit below the full scale of the converter.
//
//     y = y / (1 + (y / y_s)^q)^(1 / q)   [counts],   q infinite: y = min(y, y_s)
//
// This is a smooth limit at y_s; a larger q makes it sharper. Clipping at the full scale of the converter
// always acts and is not an effect.

#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo saturationInfo() {
  EffectInfo info;
  info.id = "saturation";
  info.summary = "the amplifier limits high readings";
  info.equation = "y = y / (1 + (y / y_s)^q)^(1 / q)";
  info.source = "form: any smooth limit; level of the circuit";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kDetector;
  info.parameters = {
      strength("level", "y_s, .inf = none", {1, INFINITY, "counts"}, 2500)
          .offAt(INFINITY)
          .within(100, 65535)
          .inBaseFit(8),
      shape("sharpness", "q, .inf = hard", {1, INFINITY, ""}, 8).trying({4, 8, INFINITY}).inBaseFit(9),
  };
  info.depends_on = {Covariate::kCode, Covariate::kPressure};
  info.collinear = {"static_curve", "trapped_gas"};
  info.detector = Detector::kSaturation;
  return info;
}

class Saturation : public Effect {
 public:
  Saturation(const EffectValues& values, const EffectContext&)
      : level_(values.at("level")), sharpness_(values.at("sharpness")) {}

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (double& reading : signals.reading) {
      if (std::isinf(sharpness_)) {
        reading = std::min(reading, level_);
      } else if (reading > 0) {
        reading /= std::pow(1 + std::pow(reading / level_, sharpness_), 1 / sharpness_);
      }
    }
  }

 private:
  double level_;  // [counts]
  double sharpness_;
};

}  // namespace

EffectEntry saturation() {
  return {saturationInfo(), makeEffect<Saturation>};
}

}  // namespace fsr::simulation
