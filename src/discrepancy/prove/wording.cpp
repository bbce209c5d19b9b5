#include "discrepancy/prove/wording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// The id of an effect, and the name in data sheets if they use the name of another effect.
std::string called(const simulation::EffectLibrary& library, const std::string& id) {
  const std::string& other = library.info(id).also_called;
  return other.empty() ? id : id + " (data sheets: " + other + ")";
}

std::string called(const simulation::EffectLibrary& library, const std::vector<std::string>& ids) {
  std::vector<std::string> names;
  for (const std::string& id : ids) names.push_back(called(library, id));
  return listText(names, " with ");
}

constexpr std::size_t kMostFigures = 3;  // of one effect

// Factor and unit in which a value is told: pressures in kPa, sizes without a unit in %. The unit "of NAME"
// means a share of the effect's pressure NAME.
std::pair<double, std::string> toldIn(const FittedParameter& one, const simulation::EffectInfo& info,
                                      const simulation::EnabledEffect* effect) {
  const std::string of = "of ";
  if (one.unit == "Pa") return {1e-3, "kPa"};
  if (one.unit.rfind(of, 0) == 0 && effect != nullptr)
    return {1e-3 * effect->values.at(one.unit.substr(of.size())), "kPa"};
  const bool share =
      one.unit.empty() && simulation::parameter(info, one.name).role != simulation::ParameterRole::kShape;
  return share ? std::pair(100.0, std::string("%")) : std::pair(1.0, one.unit);
}

// "loop width 12.1 kPa, 95 % 11.3 to 13.1".
std::string figureText(const FittedParameter& one, const std::pair<double, std::string>& told) {
  const auto& [factor, unit] = told;
  std::string text = one.name + " " + settings::roundedText(factor * one.value, 3);
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!unit.empty()) text += " " + unit;
  if (one.interval.low < one.interval.high)
    text += ", 95 % " + settings::roundedText(factor * one.interval.low, 3) + " to " +
            settings::roundedText(factor * one.interval.high, 3);
  return text;
}

// The name of an effect that was found, with its figures: sizes first, then what gives it its form.
std::string foundText(const FoundEffect& effect, const DiscrepancyReport& report) {
  const simulation::EffectLibrary& library = simulation::libraryOf(report.base);
  const simulation::EffectInfo& info = library.info(effect.id);
  std::vector<FittedParameter> parameters = effect.parameters;
  std::stable_partition(parameters.begin(), parameters.end(), [&](const FittedParameter& one) {
    return simulation::parameter(info, one.name).role != simulation::ParameterRole::kShape;
  });
  if (parameters.size() > kMostFigures) parameters.resize(kMostFigures);
  std::string figures;
  for (const FittedParameter& one : parameters) {
    if (!std::isfinite(one.value)) continue;  // a time constant that never ends
    figures +=
        (figures.empty() ? "" : "; ") + figureText(one, toldIn(one, info, report.added.effect(effect.id)));
  }
  return called(library, effect.id) + (figures.empty() ? "" : " (" + figures + ")");
}

// All effects that were found; what explains most by itself comes first.
std::string foundText(const DiscrepancyReport& report) {
  const auto alone = [&](const FoundEffect& effect) {
    const std::vector<std::string> ids = {effect.id};
    for (const CandidateScore& one : report.candidates) {
      if (one.ids == ids && one.at_map > 0) return one.at_map;
    }
    return 0.0;
  };
  std::vector<FoundEffect> effects = report.effects;
  std::stable_sort(effects.begin(), effects.end(),
                   [&](const FoundEffect& a, const FoundEffect& b) { return alone(a) > alone(b); });
  std::vector<std::string> texts;
  for (const FoundEffect& effect : effects) texts.push_back(foundText(effect, report));
  return listText(texts, " with ");
}

// The experiments that would show the effects of the verdict, e.g. "; crosstalk needs the experiment
// uneven_load".
std::string experimentsText(const DiscrepancyReport& report) {
  std::vector<std::string> needs;
  for (const NotIdentifiable& one : report.not_identifiable) {
    const auto names_it = [&](const auto& ids) { return std::count(ids.begin(), ids.end(), one.id) > 0; };
    if (!std::any_of(report.credible_set.begin(), report.credible_set.end(), names_it)) continue;
    if (one.experiment != simulation::name(simulation::Experiment::kNone))
      needs.push_back(one.id + " needs the experiment " + one.experiment);
  }
  return needs.empty() ? "" : "; " + listText(needs);
}

}  // namespace

std::string listText(const std::vector<std::string>& items, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? last : ", ";
    text += items[i];
  }
  return text;
}

std::string sentenceOf(const DiscrepancyReport& report) {
  const std::string tested = std::to_string(report.tested.size()) + " effects tested";
  std::vector<std::string> sets;
  for (const auto& ids : report.credible_set) sets.push_back(called(simulation::libraryOf(report.base), ids));
  switch (report.verdict) {
    case Verdict::kNone:
      return "Among " + tested + ", these recordings show none that is missing" +
             (report.too_small.empty() ? "." : " and larger than the least gap.");
    case Verdict::kUnknown:
      if (std::isnan(report.gap.before))
        return "The simulation lacks something, but nothing was held out, so no name can be proved. It "
               "depends on " +
               listText(report.depends_on) + ".";
      return "The simulation lacks something that none of the " + tested + " explains. It depends on " +
             listText(report.depends_on) + ".";
    case Verdict::kAmbiguous:
      return "Among " + tested +
             ", these cannot be distinguished under this protocol: " + listText(sets, " or ") + ".";
    case Verdict::kWrongForm:
      return "Best explanation among " + tested + ", under this protocol: " + foundText(report) +
             ", but in a form that differs from the library's.";
    case Verdict::kNotIdentifiable:
      return "These recordings cannot show " + listText(sets, " or ") + experimentsText(report) + ".";
    case Verdict::kNamed:
      return "Best explanation among " + tested + ", under this protocol: " + foundText(report) + ".";
  }
  return "";
}

std::string weakPartText(const std::string& part, double closed) {
  if (std::isnan(closed))
    return "On " + part + " the explanation is not tested: it can explain nothing of the common trace there.";
  return "On " + part + " the explanation is weak: fitted to all other parts, it explains " +
         settings::percentText(closed, 0) + " of the common trace there.";
}

std::string courseText(const std::string& id, double a_cycle, bool alone) {
  return "Here " + id + " is a random walk: the mean reading moves by " +
         settings::roundedText(100 * a_cycle, 2) +
         " % of full scale (standard deviation) from one cycle to the next. The scatter that is stated is "
         "what "
         "remains after the walk is filtered out." +
         (alone ? "" : " Something else remains beside it that chance does not explain.");
}

std::string idsOf(const std::vector<simulation::EnabledEffect>& effects) {
  std::vector<std::string> ids;
  for (const simulation::EnabledEffect& effect : effects) ids.push_back(effect.id);
  return listText(ids, " with ");
}

}  // namespace fsr::discrepancy
