#include "discrepancy/prove/tell_of_others.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/prove/wording.h"
#include "discrepancy/samples/admission.h"
#include "discrepancy/samples/available_evidence.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

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
