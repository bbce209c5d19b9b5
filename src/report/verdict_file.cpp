#include "report/verdict_file.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

#include "report/result_json.h"
#include "settings/settings.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

constexpr int kVerdictDigits = 5;

Json effectsOf(const Json& all) {
  Json effects = Json::array();
  for (const Json& effect : all["effects"]) {
    Json parameters = effect["parameters"];
    for (Json& parameter : parameters) parameter["unit"] = orElse(parameter["unit"], nullptr);
    effects.push_back({{"id", effect["id"]},
                       {"parameters", parameters},
                       {"evidence", pick(effect, {"z", "share_of_ceiling"})}});
  }
  return effects;
}

Json notIdentifiableOf(const Json& all) {
  Json effects = pick(all["not_identifiable"], {"id", "experiment"});
  for (Json& effect : effects) effect["experiment"] = orElse(effect["experiment"], nullptr);
  return effects;
}

Json whereOf(const Json& all) {
  Json where =
      pick(all["where"], {"taxels", "conditions", "pressure_pa=pressure", "direction", "times_s=time"});
  for (Json& one : where) one = orElse(one, "all");
  return where;
}

Json gapOf(const Json& all) {
  Json gap = pick(all["gap"], {"before", "after", "floor", "floor_bracket", "closed", "closed_interval",
                               "unit", "held_out_by", "surfaces", "covered", "left_out"});
  gap["covered"] = pick(gap["covered"], {"surface", "pressure_pa=pressure"});
  return gap;
}

// A stamp in seconds, every nanosecond kept.
std::string stampText(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1000000000;  // [ns]
  std::ostringstream text;
  text << stamp_ns / kSecond << "." << std::setw(9) << std::setfill('0') << stamp_ns % kSecond;
  return text.str();
}

Json holdOutOf(const std::vector<discrepancy::HoldOutCycles>& bags) {
  Json list = Json::array();
  for (const discrepancy::HoldOutCycles& bag : bags) {
    Json cycles = Json::array();
    for (const auto& [first, last] : bag.cycles)
      cycles.push_back(Json::array({stampText(first), stampText(last)}));
    list.push_back({{"file", bag.file}, {"cycles", cycles}});
  }
  return list;
}

// A second experiment stands in the first one, as what follows it.
Json nextOf(const Json& all) {
  Json then = nullptr;
  for (auto one = all["next_experiments"].rbegin(); one != all["next_experiments"].rend(); ++one) {
    Json next = pick(*one, {"protocol", "sentence", "separation", "cycles", "certainty"});
    next["entropy"] = Json::array({(*one)["entropy_before"], (*one)["entropy"]});
    next["then"] = then;
    then = next;
  }
  return then;
}

}  // namespace

std::string verdictText(const discrepancy::DiscrepancyReport& report) {
  const bool shows = report.verdict != discrepancy::Verdict::kNone &&
                     report.verdict != discrepancy::Verdict::kNotIdentifiable;
  const Json all = discrepancyMembers(report);
  const Json prediction = all["prediction"];
  Json verdict = pick(all, {"verdict", "effects", "credible_set", "depends_on", "p", "at_map_pa=at_map",
                            "least_gap_pa=least_gap"});
  verdict["effects"] = effectsOf(all);
  verdict["in_use"] = pick(all["in_use"], {"situation", "before_pa=before", "after_pa=after"});
  verdict["smallest_seen"] = pick(all["smallest_seen"], {"id", "at_map_pa=at_map"});
  verdict["too_small"] =
      pick(all["too_small"], {"explanation", "p", "at_map_pa=at_map", "least_gap_pa=least_gap"});
  verdict["scatter"] = pick(all["scatter"], {"part", "size", "unit", "interval", "at_map_pa=at_map"});
  verdict["asked"] = pick(all["answers"], {"id", "answer"});
  verdict["not_identifiable"] = notIdentifiableOf(all);
  verdict["where"] = shows ? whereOf(all) : Json(nullptr);
  verdict["gap"] = gapOf(all);
  verdict["hold_out"] = holdOutOf(report.hold_out);
  verdict["recompute"] = orElse(all["recompute"], nullptr);
  verdict["next_experiment"] = nextOf(all);
  verdict["prediction"] = prediction.is_null() ? prediction : pick(prediction, {"size", "weights"});
  verdict.update(pick(all, {"seed", "version"}));
  verdict["inputs"] = pick(all["inputs"], {"file", "sha256", "show_opened"});
  return "# " + report.sentence + "\n" + yamlText(verdict, kVerdictDigits);
}

namespace {

void requireEffect(const settings::Settings& file, const std::string& key, const std::string& id) {
  if (simulation::findEffect(id) == nullptr)
    throw file.error(key, "must be in the library, which has no effect \"" + id + "\"");
}

std::vector<std::string> verdictNames() {
  std::vector<std::string> names;
  for (const discrepancy::Verdict one :
       {discrepancy::Verdict::kNone, discrepancy::Verdict::kUnknown, discrepancy::Verdict::kAmbiguous,
        discrepancy::Verdict::kWrongForm, discrepancy::Verdict::kNamed,
        discrepancy::Verdict::kNotIdentifiable})
    names.push_back(discrepancy::name(one));
  return names;
}

std::vector<discrepancy::InputUse> readInputs(const settings::Settings& file) {
  constexpr std::size_t kSha256Digits = 64;
  std::vector<discrepancy::InputUse> inputs;
  for (const settings::Settings& input : file.sections("inputs")) {
    discrepancy::InputUse use;
    use.file = input.text("file");
    use.sha256 = input.text("sha256");
    if (use.sha256.size() != kSha256Digits) throw input.error("sha256", "must have 64 hexadecimal digits");
    use.hold_out_opened = static_cast<int>(input.integer("show_opened", {0, 1e9}));
    inputs.push_back(use);
  }
  return inputs;
}

// Nanoseconds of a stamp in seconds. A floating point number would lose the last of them.
std::optional<std::int64_t> stampOf(const std::string& text) {
  constexpr std::size_t kSeconds = 10, kNanos = 9;  // before and after the point
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits = text.substr(0, point) + (point < text.size() ? text.substr(point + 1) : "");
  const std::size_t fraction = digits.size() - point;
  const bool number = !digits.empty() && point <= kSeconds && fraction <= kNanos &&
                      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!number) return std::nullopt;
  digits.append(kNanos - fraction, '0');
  const std::uint64_t stamp = std::stoull(digits);  // of 19 digits, so it fits
  if (stamp > std::numeric_limits<std::int64_t>::max()) return std::nullopt;
  return static_cast<std::int64_t>(stamp);
}

std::vector<discrepancy::HoldOutCycles> readHoldOut(const settings::Settings& file) {
  std::vector<discrepancy::HoldOutCycles> bags;
  for (const settings::Settings& bag : file.sections("hold_out")) {
    bags.push_back({bag.text("file"), {}});
    for (const std::vector<std::string>& cycle : bag.lists("cycles")) {
      const bool two = cycle.size() == 2;
      const auto from = stampOf(two ? cycle[0] : ""), to = stampOf(two ? cycle[1] : "");
      if (!from || !to) throw bag.error("cycles", "must be a list of [first, last] stamps");
      if (*from > *to) throw bag.error("cycles", "must have no cycle that ends before it begins");
      bags.back().cycles.emplace_back(*from, *to);
    }
  }
  return bags;
}

// Keys that are written for other programs, or that earlier versions do not have.
void acceptOthers(const settings::Settings& file, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) file.has(key);
}

}  // namespace

VerdictFile readVerdict(const std::string& path) {
  const settings::Settings file = settings::Settings::fromFile(path);
  VerdictFile verdict;
  verdict.verdict = file.choice("verdict", verdictNames());
  for (const settings::Settings& effect : file.sections("effects")) {
    verdict.effects.push_back(effect.text("id"));
    requireEffect(effect, "id", verdict.effects.back());
    acceptOthers(effect, {"parameters", "evidence"});
  }
  verdict.credible_set = file.lists("credible_set");
  for (const auto& ids : verdict.credible_set) {
    for (const std::string& id : ids) requireEffect(file, "credible_set", id);
  }
  verdict.hold_out = readHoldOut(file);
  const settings::Settings gap = file.section("gap");
  acceptOthers(gap, gap.keys());
  verdict.gap_before = gap.numberOrNull("before", {});
  verdict.gap_after = gap.numberOrNull("after", {});
  if (gap.has("surfaces")) {
    for (const settings::Settings& one : gap.sections("surfaces"))
      verdict.gap_surfaces.push_back(
          {one.text("surface"), one.numberOrNull("before", {}), one.numberOrNull("after", {})});
  }
  verdict.seed = static_cast<std::uint64_t>(file.integer("seed", {0, 9e18}));
  verdict.version = file.text("version");
  verdict.inputs = readInputs(file);
  acceptOthers(file,
               {"depends_on", "p", "at_map", "least_gap", "in_use", "smallest_seen", "too_small", "scatter",
                "asked", "not_identifiable", "where", "recompute", "next_experiment", "prediction"});
  file.refuseUnknown();
  return verdict;
}

namespace {

const settings::Range kAnyNumber;  // includes .inf, e.g. the time constant of a drift that never ends

Json effectsOf(const std::vector<simulation::EnabledEffect>& effects) {
  Json all = Json::object();
  for (const simulation::EnabledEffect& effect : effects) {
    all[effect.id] = effect.values;
    if (!effect.carried_over) all[effect.id]["carried_over"] = false;
  }
  return all;
}

std::vector<simulation::EnabledEffect> readEffects(const settings::Settings& section) {
  std::vector<simulation::EnabledEffect> effects;
  for (const std::string& id : section.keys()) {
    if (simulation::findEffect(id) == nullptr)
      throw section.error(id, "the library has no effect of this name");
    const settings::Settings values = section.section(id);
    simulation::EnabledEffect effect{id, {}};
    effect.carried_over = values.flag("carried_over", true);
    for (const std::string& name : values.keys()) {
      if (name != "carried_over") effect.values[name] = values.number(name, kAnyNumber);
    }
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
