#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/discrepancy/base_fit.h"
#include "fsr_pressure_map/discrepancy/decision.h"
#include "fsr_pressure_map/discrepancy/refine.h"
#include "fsr_pressure_map/discrepancy/show.h"
#include "fsr_pressure_map/discrepancy/taxel_curves_fit.h"
#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

constexpr double kNotIdentifiable = 0.05;  // of a signature, that the static curves leave

// The single signature of each effect that does most of what the mixture did, as settings.
std::vector<EnabledEffect> startOf(const Competition& competition, const Score& explanation, bool& carried) {
  ColumnSet chosen;
  std::vector<EnabledEffect> effects;
  for (const std::string& id : explanation.ids) {
    Score best;
    best.total = INFINITY;
    for (const Family& family : competition.effects()) {
      if (family.id != id) continue;
      for (const ColumnSet& set : family.alternatives) {
        for (std::size_t k = 0; k < set.columns.size(); ++k) {
          const ColumnSet one{{set.columns[k]}, {set.free[k]}};
          const Score now = competition.selection().score(together(chosen, one));
          if (now.total < best.total) best = now;
        }
      }
    }
    chosen = best.set;
  }
  const Eigen::VectorXd coefficients = competition.selection().score(chosen).coefficients;
  for (std::size_t k = 0; k < chosen.columns.size(); ++k) {
    const Signature& signature = competition.signatures()[static_cast<std::size_t>(chosen.columns[k])];
    EnabledEffect effect{signature.id, signature.values};
    effect.values[signature.strength] = coefficients[static_cast<Eigen::Index>(k)] * signature.scale;
    effects.push_back(effect);
    carried = signature.carried;
  }
  return effects;
}

void listNotIdentifiable(const Measured& measured, const std::vector<Signature>& signatures,
                         const DiscrepancyProblem& problem, DiscrepancyReport& report) {
  for (const EffectEntry& entry : effectLibrary()) {
    const EffectInfo& info = entry.info;
    if (problem.simulation.effect(info.id) || info.kind == EffectKind::kBase) continue;
    double left = 0;
    bool tried = false;
    for (const Signature& s : signatures) {
      if (s.id != info.id) continue;
      tried = true;
      left = std::max(left, s.left);
    }
    const bool listed = info.kind == EffectKind::kListed;
    const bool hidden = tried && (isStatic(info) || left < kNotIdentifiable);
    if (!listed && !hidden) {
      report.tested.push_back(info.id);
      continue;
    }
    const std::string reason = listed ? "A gas chamber cannot show it."
                               : isStatic(info)
                                   ? "Under this protocol the static curves take all of it."
                                   : "Under this protocol the static curves leave hardly anything of it.";
    report.not_identifiable.push_back({info.id, name(info.experiment), reason});
  }
  static_cast<void>(measured);
}

std::string listOf(const std::vector<std::string>& ids, const std::string& between) {
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "" : between) + id;
  return text;
}

std::string sentenceOf(const DiscrepancyReport& report) {
  const std::string number = std::to_string(report.tested.size());
  switch (report.verdict) {
    case Verdict::kNone:
      return "Among " + number + " effects tested, none is missing that these recordings show.";
    case Verdict::kUnknown:
      return "Something is missing that none of the " + number + " effects tested explains; it depends on " +
             listOf(report.depends_on, ", ") + ".";
    case Verdict::kAmbiguous: {
      std::vector<std::string> sets;
      for (const auto& ids : report.credible_set) sets.push_back(listOf(ids, " with "));
      return "Among " + number +
             " effects tested, these recordings do not tell apart: " + listOf(sets, ", or ") + ".";
    }
    case Verdict::kWrongForm:
      return "Best explanation among " + number +
             " effects tested: " + listOf(report.credible_set.front(), " and ") +
             ", but its form in the library does not fit well.";
    default:
      return "Best explanation among " + number +
             " effects tested, under this protocol: " + listOf(report.credible_set.front(), " and ") + ".";
  }
}

}  // namespace

DiscrepancyReport investigate(const DiscrepancyProblem& problem, const DiscrepancyProgress& progress) {
  const auto tell = [&](const char* step, double share) {
    if (progress) progress(step, share);
  };
  validate(problem);
  tell("reading", 0);
  const Measured measured = admit(problem);
  tell("static curves", 0.1);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  DiscrepancyReport report;
  report.seed = problem.options.seed;
  report.version = FSR_VERSION;
  report.limitations = measured.limitations;
  for (const Recording& recording : problem.recordings) {
    report.inputs.push_back({recording.name, recording.sha256, recording.scans(), 1});
  }
  report.base = report.added = fitBase(measured, fit, problem.simulation);
  tell("signatures", 0.2);
  const Competition competition(
      measured, common, fit,
      signatures(measured, fit, report.base, problem.options.leave_out, problem.options.threads),
      problem.options.threads);
  listNotIdentifiable(measured, competition.signatures(), problem, report);
  tell("naming", 0.7);
  const TaxelFit taxels(measured, fit);
  const Decision decision = decide(measured, taxels, competition);
  report.verdict = decision.verdict;
  report.credible_set = decision.credible;
  report.depends_on = decision.depends_on;
  report.candidates = decision.candidates;
  report.sentence = sentenceOf(report);
  Trace left = Trace::Zero(common.all.size());
  if (!decision.credible.empty()) {
    tell("refining", 0.8);
    bool carried = true;
    const std::vector<EnabledEffect> start = startOf(competition, decision.explanation, carried);
    const Refined refined = refine(measured, common, report.base, start, carried);
    for (std::size_t e = 0; e < refined.effects.size(); ++e) {
      report.added = withEffect(report.added, refined.effects[e]);
      const EffectInfo& info = findEffect(refined.effects[e].id)->info;
      report.effects.push_back(
          {info.id, info.summary, refined.parameters[e], decision.z, decision.share / decision.ceiling});
    }
    left = fit.residual(refined.trace);
  } else if (decision.verdict == Verdict::kUnknown) {
    left = fit.residual(competition.explained(decision.explanation));
  }
  tell("showing", 0.9);
  const Spread spread = spreadOf(measured, taxels, left);
  const double to_error = spread.square > 0 ? competition.meanSquare() * spread.local / spread.square : 0;
  if (decision.verdict != Verdict::kNone) report.where = placeOf(measured, left, spread);
  report.gap = measureGap(measured, fit, taxels, left, maskOf(measured, report.where, spread),
                          std::min(1.0, decision.ceiling * to_error), problem.options.seed);
  const Trace before = fit.residual(common.all);
  report.curves = residualCurves(measured, before, before - left);
  report.base = withTaxelCurves(measured, report.base, "base_curves.csv");
  report.added = withTaxelCurves(measured, report.added, "simulation_curves.csv");
  tell("done", 1);
  return report;
}

}  // namespace fsr
