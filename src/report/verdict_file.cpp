#include "report/verdict_file.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

#include "report/members_yaml.h"
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
  verdict["too_small"] = pick(all["too_small"], {"explanation", "p", "at_map_pa=at_map"});
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

}  // namespace fsr::report
