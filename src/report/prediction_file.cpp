#include "report/prediction_file.h"

#include "settings/settings.h"
#include "settings/yaml_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

const settings::Range kAnyNumber;  // includes .inf, e.g. the time constant of a drift that never ends

std::string effectsText(const std::vector<simulation::EnabledEffect>& effects) {
  std::string text;
  for (const simulation::EnabledEffect& effect : effects) {
    std::string values;
    for (const auto& [name, value] : effect.values) {
      values += (values.empty() ? "" : ", ") + name + ": " + settings::numberText(value);
    }
    text += (text.empty() ? "" : ", ") + effect.id + ": {" + values + "}";
  }
  return "{" + text + "}";
}

std::vector<simulation::EnabledEffect> readEffects(const settings::Settings& section) {
  std::vector<simulation::EnabledEffect> effects;
  for (const std::string& id : section.keys()) {
    if (simulation::findEffect(id) == nullptr)
      throw section.error(id, "the library has no effect of this name");
    const settings::Settings values = section.section(id);
    simulation::EnabledEffect effect{id, {}};
    for (const std::string& name : values.keys()) effect.values[name] = values.number(name, kAnyNumber);
    effects.push_back(effect);
  }
  return effects;
}

}  // namespace

std::string predictionText(const FrozenPrediction& frozen) {
  const discrepancy::Prediction& prediction = frozen.prediction;
  std::string rivals;
  for (const auto& rival : prediction.rivals) rivals += "\n  - " + effectsText(rival);
  return "# Frozen together with the verdict beside it. If this file is edited, the hash below no longer "
         "fits.\n"
         "verdict_sha256: \"" +
         frozen.verdict_sha256 + "\"\neffects: " + effectsText(prediction.effects) +
         "\nrivals:" + (rivals.empty() ? " []" : rivals) + "\nsize: [" +
         settings::numberText(prediction.size.low) + ", " + settings::numberText(prediction.size.high) +
         "]\nhash: \"" + prediction.hash + "\"\n";
}

FrozenPrediction readPrediction(const std::string& path) {
  const settings::Settings file = settings::Settings::fromFile(path);
  FrozenPrediction frozen;
  frozen.verdict_sha256 = file.text("verdict_sha256");
  frozen.prediction.effects = readEffects(file.section("effects"));
  for (const settings::Settings& rival : file.sections("rivals"))
    frozen.prediction.rivals.push_back(readEffects(rival));
  const std::vector<double> size = file.numbers("size", kAnyNumber);
  if (size.size() != 2) throw file.error("size", "must be two numbers, [low, high]");
  frozen.prediction.size = {size[0], size[1]};
  frozen.prediction.hash = file.text("hash");
  file.refuseUnknown();
  return frozen;
}

}  // namespace fsr::report
