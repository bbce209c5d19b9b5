#include "fsr_pressure_map/report/prediction_file.h"

#include "fsr_pressure_map/settings/settings.h"
#include "fsr_pressure_map/settings/yaml_text.h"
#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

const Range kAnyNumber;  // .inf among them: a drift that never ends

std::string effectsText(const std::vector<EnabledEffect>& effects) {
  std::string text;
  for (const EnabledEffect& effect : effects) {
    std::string values;
    for (const auto& [name, value] : effect.values) {
      values += (values.empty() ? "" : ", ") + name + ": " + numberText(value);
    }
    text += (text.empty() ? "" : ", ") + effect.id + ": {" + values + "}";
  }
  return "{" + text + "}";
}

std::vector<EnabledEffect> readEffects(const Settings& section) {
  std::vector<EnabledEffect> effects;
  for (const std::string& id : section.keys()) {
    if (findEffect(id) == nullptr) throw section.error(id, "no effect of the library is called so");
    const Settings values = section.section(id);
    EnabledEffect effect{id, {}};
    for (const std::string& name : values.keys()) effect.values[name] = values.number(name, kAnyNumber);
    effects.push_back(effect);
  }
  return effects;
}

}  // namespace

std::string predictionText(const FrozenPrediction& frozen) {
  const Prediction& prediction = frozen.prediction;
  std::string rivals;
  for (const auto& rival : prediction.rivals) rivals += "\n  - " + effectsText(rival);
  return "# Frozen with the verdict beside it. An edited file no longer has the hash below.\n"
         "verdict_sha256: \"" +
         frozen.verdict_sha256 + "\"\neffects: " + effectsText(prediction.effects) +
         "\nrivals:" + (rivals.empty() ? " []" : rivals) + "\nsize: [" + numberText(prediction.size.low) +
         ", " + numberText(prediction.size.high) + "]\nhash: \"" + prediction.hash + "\"\n";
}

FrozenPrediction readPrediction(const std::string& path) {
  const Settings file = Settings::fromFile(path);
  FrozenPrediction frozen;
  frozen.verdict_sha256 = file.text("verdict_sha256");
  frozen.prediction.effects = readEffects(file.section("effects"));
  for (const Settings& rival : file.sections("rivals"))
    frozen.prediction.rivals.push_back(readEffects(rival));
  const std::vector<double> size = file.numbers("size", kAnyNumber);
  if (size.size() != 2) throw file.error("size", "must be two numbers, [low, high]");
  frozen.prediction.size = {size[0], size[1]};
  frozen.prediction.hash = file.text("hash");
  file.refuseUnknown();
  return frozen;
}

}  // namespace fsr
