// A fit tends to find what it looks for. A finding is therefore tested on new recordings: the outcome of the
// next experiment is predicted, and a hash protects the prediction from changes. The new recordings confirm
// the prediction or not. To compute what the prediction explains, only the static curves and the base
// parameters of the simulation are fitted to them.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/base_fit.h"
#include "discrepancy/prove/prediction_hash.h"
#include "discrepancy/prove/wording.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// Smallest share of the common trace's squared error that a true prediction explains.
constexpr double kLeastShare = 0.3;
// Share of the same error. A rival that explains more than the prediction by this much refutes it.
constexpr double kRivalBetter = 0.03;

std::string idsOf(const std::vector<simulation::EnabledEffect>& effects) {
  std::vector<std::string> ids;
  for (const simulation::EnabledEffect& effect : effects) ids.push_back(effect.id);
  return listText(ids, " with ");
}

// Analyses the new recordings without using the prediction. Returns the best explanation if no credible
// explanation contains the predicted effect `id`, else an empty text.
std::string excludedBy(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                       const simulation::SimulationSettings& base, const std::string& id) {
  const TaxelFit taxels(measured, fit);
  const Candidates candidates(measured, common, fit, signatures(measured, fit, base, {}, 0), 0);
  const Decision decision = decide(measured, common, fit, taxels, candidates, base);
  const auto& credible = decision.credible;
  const bool in = std::any_of(credible.begin(), credible.end(), [&](const std::vector<std::string>& ids) {
    return std::count(ids.begin(), ids.end(), id) > 0;
  });
  return in || credible.empty() ? "" : listText(credible.front(), " with ");
}

}  // namespace

Confirmation confirm(const Prediction& prediction, const simulation::SimulationSettings& simulation,
                     const std::vector<dataset::Recording>& recordings) {
  if (prediction.effects.empty())
    throw settings::InputError("prediction: it contains no effect, so there is nothing to confirm");
  if (!hasItsHash(prediction, simulation)) {
    throw settings::InputError(
        "prediction: its hash does not fit its content or base.yaml; one of them was changed after it was "
        "written");
  }
  DiscrepancyProblem problem;
  problem.simulation = simulation;
  problem.recordings = recordings;
  validate(problem);
  Measured measured = admit(problem);
  const CommonTraces first = commonTraces(measured);
  const StaticFit first_fit(measured, CurvePer::kClass, first.all);
  const simulation::SimulationSettings base = fitBase(measured, first_fit, simulation);
  takeOutEnabled(measured, first, first_fit, base, false);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  Confirmation confirmation;
  const Predicted told = predict(measured, common, fit, base, prediction.effects);
  confirmation.share_of_error = told.share;
  confirmation.size = told.size;
  confirmation.interval = told.interval;
  double most = told.share;
  for (const auto& rival : prediction.rivals) {
    const double share = predict(measured, common, fit, base, rival).best_share;
    if (share <= std::max(most, told.best_share + kRivalBetter)) continue;
    most = share;
    confirmation.best_rival = idsOf(rival);
  }
  if (confirmation.best_rival.empty())
    confirmation.best_rival = excludedBy(measured, common, fit, base, prediction.effects.front().id);
  const bool size_fits =
      told.interval.high >= prediction.size.low && told.interval.low <= prediction.size.high;
  confirmation.passed = told.share >= kLeastShare && size_fits && confirmation.best_rival.empty();
  std::ostringstream text;
  text.precision(3);
  text << idsOf(prediction.effects) << (confirmation.passed ? " is confirmed: " : " is not confirmed: ")
       << "as predicted it explains " << 100 * std::max(0.0, told.share)
       << " % of the common squared error, at " << told.size << " times its size";
  if (!confirmation.best_rival.empty()) text << "; " << confirmation.best_rival << " explains more";
  if (!size_fits)
    text << ", but the prediction was " << prediction.size.low << " to " << prediction.size.high;
  text << ".";
  confirmation.sentence = text.str();
  return confirmation;
}

}  // namespace fsr::discrepancy
