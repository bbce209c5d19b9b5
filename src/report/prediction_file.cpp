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

std::string numbersText(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + settings::numberText(number);
  return "[" + text + "]";
}

// Nothing where an earlier version made the prediction: its hash covers no distribution.
std::string distributionText(const discrepancy::Prediction& prediction) {
  const discrepancy::ParameterSpread& spread = prediction.spread;
  if (prediction.weights.empty()) return "";
  std::string parameters;
  for (std::size_t k = 0; k < spread.parameters.size(); ++k) {
    const auto& one = spread.parameters[k];
    parameters += "\n    - {effect: " + std::to_string(one.effect) + ", name: " + one.name +
                  ", logarithmic: " + (one.logarithmic ? "true" : "false") +
                  ", covariance: " + numbersText(spread.covariance[k]) + "}";
  }
  return "weights: " + numbersText(prediction.weights) +
         "\nspread:\n  cycles: " + std::to_string(spread.cycles) +
         "\n  groups: " + std::to_string(spread.groups) +
         "\n  between: " + settings::numberText(spread.between) +
         "\n  parameters:" + (parameters.empty() ? " []" : parameters) + "\n";
}

std::string pacesText(const std::vector<dataset::CycleCourse>& paces) {
  std::string text;
  for (const dataset::CycleCourse& pace : paces)
    text += "\n  - {speed: " + settings::numberText(pace.speed) +
            ", dwell: " + settings::numberText(pace.dwell) + ", peak: " + settings::numberText(pace.peak) +
            "}";
  return text.empty() ? "" : "paces:" + text + "\n";
}

std::string readingsText(const std::vector<std::string>& readings) {
  std::string text;
  for (const std::string& sha256 : readings) text += "\n  - \"" + sha256 + "\"";
  return text.empty() ? "" : "readings_sha256:" + text + "\n";
}

std::size_t readCount(const settings::Settings& file, const std::string& key) {
  return static_cast<std::size_t>(file.number(key, {0, 1e9}));
}

discrepancy::ParameterSpread readSpread(const settings::Settings& file, const discrepancy::Prediction& of) {
  discrepancy::ParameterSpread spread;
  spread.cycles = readCount(file, "cycles");
  spread.groups = readCount(file, "groups");
  spread.between = file.number("between", {0, 1e9});
  const std::vector<settings::Settings> parameters = file.sections("parameters");
  for (const settings::Settings& one : parameters) {
    discrepancy::ParameterSpread::Parameter parameter;
    parameter.effect = readCount(one, "effect");
    parameter.name = one.text("name");
    parameter.logarithmic = one.flag("logarithmic", false);
    if (parameter.effect >= of.effects.size() || !of.effects[parameter.effect].values.count(parameter.name))
      throw one.error("name", "must be a parameter of the effect with this number");
    spread.covariance.push_back(one.numbers("covariance", kAnyNumber));
    if (spread.covariance.back().size() != parameters.size())
      throw one.error("covariance", "must be one number for each parameter");
    spread.parameters.push_back(parameter);
  }
  return spread;
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
         "]\n" + distributionText(prediction) + pacesText(frozen.paces) +
         readingsText(frozen.readings_sha256) + "hash: \"" + prediction.hash + "\"\n";
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
  if (file.has("weights")) {
    frozen.prediction.weights = file.numbers("weights", {0, 1});
    frozen.prediction.spread = readSpread(file.section("spread"), frozen.prediction);
  }
  if (file.has("paces")) {
    for (const settings::Settings& pace : file.sections("paces"))
      frozen.paces.push_back({pace.number("speed", kAnyNumber), pace.number("dwell", kAnyNumber),
                              pace.number("peak", kAnyNumber)});
  }
  if (file.has("readings_sha256")) frozen.readings_sha256 = file.texts("readings_sha256");
  frozen.prediction.hash = file.text("hash");
  file.refuseUnknown();
  return frozen;
}

}  // namespace fsr::report
