// A fit tends to find what it looks for. A finding is therefore tested on new recordings: the outcome of the
// next experiment is predicted, and a hash protects the prediction from changes. The new recordings confirm
// the prediction or not. Only the static curves, the base parameters of the simulation, the noise and the
// common size of the predicted effects are fitted to them.

#include <algorithm>
#include <cmath>
#include <memory>

#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/parameter_fit.h"
#include "discrepancy/prove/freeze.h"
#include "discrepancy/prove/wording.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// Analyses the new recordings without using the prediction. Returns the best explanation if no credible
// explanation contains the predicted effect `id`, else an empty text.
std::string excludedBy(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                       const simulation::SimulationSettings& base, const std::string& id) {
  const Candidates candidates(measured, fit, signatures(measured, fit, base, {}, 0));
  const Decision decision = decide(measured, common, fit, candidates, base, {});
  const auto& credible = decision.credible;
  const bool in = std::any_of(credible.begin(), credible.end(), [&](const std::vector<std::string>& ids) {
    return std::count(ids.begin(), ids.end(), id) > 0;
  });
  return in || credible.empty() ? "" : listText(credible.front(), " with ");
}

// The new recordings, ready for a comparison. Nothing is held out: nothing but the size is fitted to them.
struct NewRecordings {
  Measured measured;
  simulation::SimulationSettings base;
  CommonTraces common;
  std::unique_ptr<StaticFit> fit;

  explicit NewRecordings(const DiscrepancyProblem& problem) : measured(admit(problem)) {
    for (MeasuredCycle& cycle : measured.cycles) cycle.use = CycleUse::kFit;
    const CommonTraces first = commonTraces(measured);
    const StaticFit first_fit(measured, CurvePer::kClass, first.all);
    base = fitBase(measured, first_fit, problem.simulation);
    takeOutEnabled(measured, first, first_fit, base, false);
    common = commonTraces(measured);
    fit = std::make_unique<StaticFit>(measured, CurvePer::kClass, common.all);
  }
  Predicted predicted(const std::vector<simulation::EnabledEffect>& effects,
                      const ParameterSpread& spread = {}) const {
    return predict(measured, common, *fit, base, effects, spread);
  }
};

// Compares the prediction with its rivals by the predictive density of the new cycles, as decide() does. Each
// explanation is one column: what its effects add, with the size that fits the new cycles best.
void compareRivals(const NewRecordings& now, const Prediction& prediction, const Trace& predicted,
                   Confirmation& confirmation) {
  std::vector<Trace> traces = {predicted};
  for (const auto& rival : prediction.rivals) traces.push_back(now.predicted(rival).trace);
  Eigen::MatrixXd columns(predicted.size(), static_cast<Eigen::Index>(traces.size()));
  std::vector<Explaining> explanations;
  for (std::size_t e = 0; e < traces.size(); ++e) {
    const double rms = std::sqrt(traces[e].squaredNorm() / static_cast<double>(predicted.size()));
    columns.col(static_cast<Eigen::Index>(e)) = traces[e] / std::max(rms, 1e-300);
    const std::string name = e == 0 ? "" : idsOf(prediction.rivals[e - 1]);
    explanations.push_back({{name}, {{{static_cast<Eigen::Index>(e)}, {false}, false, true}}, {}, false});
    if (e > 0) confirmation.rivals.push_back({name, 0, false});
  }
  const CycleDesign design = cycleDesign(now.measured, *now.fit, now.common.all, columns);
  if (design.cycles.size() < 2) return;
  const DiscrepancyOptions options;
  const Appraisal appraisal = appraise(design, fitNull(design), explanations, options);
  confirmation.p = appraisal.p;
  const auto& credible = appraisal.credible;
  const bool beaten = !std::count(credible.begin(), credible.end(), std::size_t{0});
  for (std::size_t r = 0; r < confirmation.rivals.size(); ++r) {
    RivalAnswer& rival = confirmation.rivals[r];
    rival.nats = appraisal.all[r + 1].total - appraisal.all[0].total;
    rival.better = beaten && std::count(credible.begin(), credible.end(), r + 1) > 0;
  }
  if (beaten && !credible.empty() && credible.front() > 0)
    confirmation.best_rival = confirmation.rivals[credible.front() - 1].explanation;
}

// A prediction of an earlier version is an interval only.
Interval intervalFor(const Prediction& prediction, const Predicted& told, const Measured& measured) {
  if (!prediction.spread.parameters.empty())
    return predictiveInterval(told, prediction.spread, measured.cycles.size());
  constexpr double kTwoSided = 1.96;  // 95 % of a normal distribution
  const double reach = kTwoSided * std::sqrt(told.variance);
  return {prediction.size.low - reach, prediction.size.high + reach};
}

std::string rangeText(const Interval& interval) {
  return settings::fixedText(interval.low, 3) + " to " + settings::fixedText(interval.high, 3);
}

std::string sentenceOf(const Prediction& prediction, const Confirmation& confirmation, bool size_fits,
                       bool visible) {
  std::string text = idsOf(prediction.effects) +
                     (confirmation.passed ? " is confirmed: " : " is not confirmed: ") + "its size is " +
                     settings::fixedText(confirmation.size, 3) + " times the predicted one, and " +
                     rangeText(confirmation.predicted) + " was predicted for these bags (95 %)";
  if (!size_fits) text += ", which does not hold it";
  if (!visible) text += "; it is not visible beyond chance in the new cycles";
  if (!confirmation.best_rival.empty())
    text += "; " + confirmation.best_rival + " explains the new bags better";
  if (prediction.spread.parameters.empty())
    text += "; the prediction is from an earlier version, which did not compute the range";
  return text + ".";
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
  for (const ParameterSpread::Parameter& one : prediction.spread.parameters) {
    if (one.effect >= prediction.effects.size() || !prediction.effects[one.effect].values.count(one.name))
      throw settings::InputError("prediction: its spread is of '" + one.name +
                                 "', but must be of parameters of its effects");
  }
  DiscrepancyProblem problem;
  problem.simulation = simulation;
  problem.recordings = recordings;
  validate(problem);
  const NewRecordings now(problem);
  Confirmation confirmation;
  const Predicted told = now.predicted(prediction.effects, prediction.spread);
  confirmation.share_of_error = told.share;
  confirmation.size = told.size;
  confirmation.predicted = intervalFor(prediction, told, now.measured);
  confirmation.interval = sizeInterval(told, now.measured.cycles.size());
  compareRivals(now, prediction, told.trace, confirmation);
  if (confirmation.best_rival.empty())
    confirmation.best_rival =
        excludedBy(now.measured, now.common, *now.fit, now.base, prediction.effects.front().id);
  const bool size_fits = told.size >= confirmation.predicted.low && told.size <= confirmation.predicted.high;
  const bool visible = confirmation.p <= DiscrepancyOptions().level;
  confirmation.passed = size_fits && visible && confirmation.best_rival.empty();
  confirmation.sentence = sentenceOf(prediction, confirmation, size_fits, visible);
  return confirmation;
}

}  // namespace fsr::discrepancy
