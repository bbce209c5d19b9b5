#include "discrepancy/prove/wording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/samples/admission.h"
#include "discrepancy/samples/available_evidence.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

std::string name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNone:
      return "none";
    case Verdict::kUnknown:
      return "unknown";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kWrongForm:
      return "wrong_form";
    case Verdict::kNamed:
      return "named";
    case Verdict::kNotIdentifiable:
      return "not_identifiable";
  }
  return "";
}

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

namespace {

using Ids = std::vector<std::string>;

Answer inSimulation(const std::string& id) {
  return {id, "in_simulation", NAN, "The simulation has it already."};
}

Answer leftOut(const std::string& id) {
  return {id, "left_out", NAN, "It was left out of the library."};
}

class Others {
 public:
  Others(const DiscrepancyProblem& problem, const Measured& measured, const Candidates& candidates,
         const Decision& decision, DiscrepancyReport& report)
      : problem_(problem),
        measured_(measured),
        candidates_(candidates),
        decision_(decision),
        report_(report),
        evidence_(availableEvidence(measured)) {}

  void listNotIdentifiable();
  void answerQuestions();

 private:
  bool inLibrary(const std::string& id) const {
    return mayBeFound(id, problem_.simulation, problem_.options.leave_out);
  }
  bool hidden(const std::string& id) const;
  std::string notLookedFor(const simulation::EffectInfo& info) const;
  Answer answerTo(const std::string& id) const;

  const DiscrepancyProblem& problem_;
  const Measured& measured_;
  const Candidates& candidates_;
  const Decision& decision_;
  DiscrepancyReport& report_;
  AvailableEvidence evidence_;
};

// Whether an effect competed although no plausible strength of it would have been found.
bool Others::hidden(const std::string& id) const {
  const auto& seen = decision_.smallest_seen;
  return std::any_of(seen.begin(), seen.end(),
                     [&](const SmallestSeen& one) { return one.id == id && std::isnan(one.at_map); });
}

std::string Others::notLookedFor(const simulation::EffectInfo& info) const {
  std::string lacking;
  for (const simulation::Evidence need : info.needs) {
    if (!evidence_.has(need)) lacking += (lacking.empty() ? "" : ", ") + simulation::name(need);
  }
  std::replace(lacking.begin(), lacking.end(), '_', ' ');
  return lacking.empty() ? "It is not looked for in this version." : "It needs " + lacking + ".";
}

void Others::listNotIdentifiable() {
  for (const simulation::EffectEntry& entry : measured_.effects().entries()) {
    const simulation::EffectInfo& info = entry.info;
    if (!inLibrary(info.id) || info.kind == simulation::EffectKind::kBase) continue;
    const auto& all = candidates_.signatures();
    const bool tried =
        std::any_of(all.begin(), all.end(), [&](const Signature& s) { return s.id == info.id; });
    std::string reason;
    if (info.kind == simulation::EffectKind::kListed) reason = "A gas chamber cannot show it.";
    if (tried && isStatic(info)) reason = "Under a uniform pressure the static curves absorb all of it.";
    if (hidden(info.id)) reason = "Under this protocol no plausible strength of it would be seen.";
    if (info.detector == simulation::Detector::kMounts && !evidence_.remounted)
      reason = "No surface was mounted twice.";
    if (!info.looked_for) reason = notLookedFor(info);
    const bool found = std::any_of(report_.effects.begin(), report_.effects.end(),
                                   [&](const FoundEffect& effect) { return effect.id == info.id; });
    if (reason.empty() || found) {
      report_.tested.push_back(info.id);
    } else {
      report_.not_identifiable.push_back({info.id, simulation::name(info.experiment), reason});
    }
  }
}

void Others::answerQuestions() {
  for (const std::string& id : problem_.options.ask) report_.answers.push_back(answerTo(id));
  if (report_.verdict != Verdict::kNone) return;
  Ids hidden;
  for (const Answer& answer : report_.answers) {
    if (answer.answer == "not_identifiable") hidden.push_back(answer.id);
  }
  if (hidden.empty()) return;
  report_.verdict = Verdict::kNotIdentifiable;
  for (const std::string& id : hidden) report_.credible_set.push_back({id});
}

Answer Others::answerTo(const std::string& id) const {
  if (problem_.simulation.effect(id)) return inSimulation(id);
  if (!inLibrary(id)) return leftOut(id);
  for (const FoundEffect& effect : report_.effects) {
    if (effect.id == id) return {id, "found", NAN, "It is a part of the best explanation."};
  }
  const auto names_it = [&](const Ids& ids) { return std::count(ids.begin(), ids.end(), id) > 0; };
  if (std::any_of(report_.credible_set.begin(), report_.credible_set.end(), names_it))
    return {id, "not_excluded", NAN, "It is not excluded."};
  for (const CandidateScore& candidate : report_.candidates) {
    if (candidate.outcome == "required_data_missing" && names_it(candidate.ids))
      return {id, "not_excluded", NAN, "It is not excluded, but nothing was held out to prove it."};
  }
  for (const NotIdentifiable& one : report_.not_identifiable) {
    if (one.id == id) return {id, "not_identifiable", NAN, one.reason};
  }
  if (!std::count(report_.tested.begin(), report_.tested.end(), id))
    return {id, "left_out", NAN, "It is not looked for."};
  for (const SmallestSeen& seen : report_.smallest_seen) {
    if (seen.id == id) return {id, "excluded", seen.at_map, "It was tested and not found."};
  }
  return {id, "excluded", NAN, "It was tested and not found."};
}

}  // namespace

void tellOfOthers(const DiscrepancyProblem& problem, const Measured& measured, const Candidates& candidates,
                  const Decision& decision, DiscrepancyReport& report) {
  Others others(problem, measured, candidates, decision, report);
  others.listNotIdentifiable();
  others.answerQuestions();
}

void abstainIfUnfit(const std::vector<dataset::Recording>& recordings, DiscrepancyReport& report) {
  if (report.verdict != Verdict::kNone && report.verdict != Verdict::kNotIdentifiable) return;
  const std::vector<std::string> reasons = whyNotFit(recordings);
  if (reasons.empty()) return;
  report.verdict = Verdict::kNotIdentifiable;
  report.sentence =
      "Nothing was found, but these recordings could not have shown it: " + reasons.front() + ".";
  report.smallest_seen.clear();
  for (const std::string& reason : reasons) report.limitations.push_back(reason + ".");
  for (Answer& answer : report.answers) {
    if (answer.answer != "excluded") continue;
    answer = {answer.id, "not_identifiable", NAN, "The recordings are not fit to show it."};
    report.credible_set.push_back({answer.id});
  }
}

std::optional<DiscrepancyReport> answersWithoutCycles(const DiscrepancyProblem& problem,
                                                      const std::string& reason) {
  DiscrepancyReport report;
  report.verdict = Verdict::kNotIdentifiable;
  for (const std::string& id : problem.options.ask) {
    if (problem.simulation.effect(id)) {
      report.answers.push_back(inSimulation(id));
    } else if (!mayBeFound(id, problem.simulation, problem.options.leave_out)) {
      report.answers.push_back(leftOut(id));
    } else {
      const simulation::EffectInfo& info = simulation::libraryOf(problem.simulation).info(id);
      report.answers.push_back({id, "not_identifiable", NAN, reason + "."});
      report.not_identifiable.push_back({id, simulation::name(info.experiment), reason + "."});
      report.credible_set.push_back({id});
    }
  }
  if (report.credible_set.empty()) return std::nullopt;
  report.base = report.added = problem.simulation;
  report.options = problem.options;
  report.p = report.least_gap = NAN;
  report.gap.missing = {"Too few cycles to compare, so nothing was looked for: record more cycles."};
  report.seed = problem.options.seed;
  report.version = FSR_VERSION;
  for (const dataset::Recording& recording : problem.recordings)
    report.inputs.push_back({recording.name, recording.sha256, recording.scans(), 0});
  report.sentence = sentenceOf(report);
  return report;
}

}  // namespace fsr::discrepancy
