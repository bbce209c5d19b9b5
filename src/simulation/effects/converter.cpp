// Zero-potential read-out and analogue-to-digital converter: counts are proportional to the conductance.
//
//     y = full_scale V / V_ref,  V = V_ref R_f G   [counts]
//
// The reference of the converter also drives the matrix, so that V_ref cancels. After all effects of the
// reading the chain rounds y to whole counts and clips it to 0 .. full_scale. One count of 12 bits is 0.024
// % of full scale. Circuit: Fig. 2 of Ahmadizadeh and Menon 2019.

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo converterInfo() {
  EffectInfo info;
  info.id = "converter";
  info.summary = "conductance to counts; rounding and clipping at the end of the chain";
  info.equation = "y = full_scale R_f G + offset";
  info.source = "zero-potential circuit of the paper's Fig. 2";
  info.stage = ChainStage::kSample;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kBase;
  info.required = true;
  info.parameters = {
      shape("full_scale", "largest count", {1, 65535, "counts"}, 4095),
      shape("feedback_resistance", "R_f", {1, 1e9, "ohm"}, 3600),
      strength("offset", "reading at no conductance", {0, 65535, "counts"}, 0).within(0, 500),
  };
  return info;
}

class Converter : public Effect {
 public:
  Converter(const EffectValues& values, const EffectContext&)
      : counts_per_siemens_(values.at("full_scale") * values.at("feedback_resistance")),
        offset_(values.at("offset")) {
    if (values.at("full_scale") != std::floor(values.at("full_scale"))) {
      throw settings::InputError("effects.converter: full_scale must be a whole number of counts, e.g. 4095");
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < signals.reading.size(); ++i) {
      signals.reading[i] = counts_per_siemens_ * signals.conductance[i] + offset_;
    }
  }

 private:
  double counts_per_siemens_;
  double offset_;  // [counts]
};

}  // namespace

EffectEntry converter() {
  return {converterInfo(), makeEffect<Converter>};
}

}  // namespace fsr::simulation
