#include "report/prediction_file.h"

#include "report/members_yaml.h"
#include "settings/settings.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

const settings::Range kAnyNumber;  // includes .inf, e.g. the time constant of a drift that never ends

Json effectsOf(const std::vector<simulation::EnabledEffect>& effects) {
  Json all = Json::object();
  for (const simulation::EnabledEffect& effect : effects) all[effect.id] = effect.values;
  return all;
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

Json spreadOf(const discrepancy::ParameterSpread& spread) {
  Json parameters = Json::array();
  for (std::size_t k = 0; k < spread.parameters.size(); ++k) {
    const auto& one = spread.parameters[k];
    parameters.push_back({{"effect", one.effect},
                          {"name", one.name},
                          {"logarithmic", one.logarithmic},
                          {"covariance", spread.covariance[k]}});
  }
  return {{"cycles", spread.cycles},
          {"groups", spread.groups},
          {"between", spread.between},
          {"parameters", parameters}};
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
  Json rivals = Json::array(), paces = Json::array();
  for (const auto& rival : prediction.rivals) rivals.push_back(effectsOf(rival));
  for (const dataset::CycleCourse& pace : frozen.paces)
    paces.push_back({{"speed", pace.speed}, {"dwell", pace.dwell}, {"peak", pace.peak}});
  Json all = {{"verdict_sha256", frozen.verdict_sha256},
              {"effects", effectsOf(prediction.effects)},
              {"rivals", rivals},
              {"size", Json::array({prediction.size.low, prediction.size.high})}};
  // Nothing where an earlier version made the prediction: its hash covers no distribution.
  if (!prediction.weights.empty()) {
    all["weights"] = prediction.weights;
    all["spread"] = spreadOf(prediction.spread);
  }
  if (!paces.empty()) all["paces"] = paces;
  if (!frozen.readings_sha256.empty()) all["readings_sha256"] = frozen.readings_sha256;
  all["hash"] = prediction.hash;
  return "# Frozen together with the verdict beside it. If this file is edited, the hash below no longer "
         "fits.\n" +
         yamlText(all, kAllDigits);
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
