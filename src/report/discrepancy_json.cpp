#include "report/discrepancy_report.h"
#include "report/result_json.h"

namespace fsr::report {

namespace {

Json json(const discrepancy::Interval& interval) {
  return Json::array({interval.low, interval.high});
}

Json json(const discrepancy::FoundEffect& effect) {
  Json parameters = Json::array();
  for (const discrepancy::FittedParameter& p : effect.parameters) {
    parameters.push_back(
        {{"name", p.name}, {"value", p.value}, {"unit", p.unit}, {"interval", json(p.interval)}});
  }
  return {{"id", effect.id},
          {"summary", effect.summary},
          {"parameters", parameters},
          {"z", effect.z},
          {"share_of_ceiling", effect.share_of_explainable}};
}

Json json(const discrepancy::NotIdentifiable& effect) {
  return {{"id", effect.id}, {"experiment", effect.experiment}, {"reason", effect.reason}};
}

Json json(const discrepancy::CovariateTest& test) {
  return {{"covariate", test.covariate}, {"method", test.method},    {"p", test.p},
          {"adjusted_p", test.adjusted}, {"at_map_pa", test.at_map}, {"depends", test.depends}};
}

Json json(const discrepancy::WhereItShows& where) {
  return {{"taxels", where.taxels},
          {"conditions", where.conditions},
          {"pressure_pa", json(where.pressure)},
          {"direction", where.direction},
          {"times_s", where.times}};
}

Json json(const discrepancy::HeldOutGap& held) {
  Json parts = Json::array();
  for (const auto& [part, closed] : held.parts) parts.push_back({{"part", part}, {"closed", closed}});
  return {{"by", held.by},
          {"closed", held.closed},
          {"closed_interval", json(held.closed_interval)},
          {"parts", parts}};
}

Json json(const discrepancy::Gap& gap) {
  Json foretold = Json::array();
  for (const discrepancy::HeldOutGap& held : gap.foretold) foretold.push_back(json(held));
  Json covered = Json::array();
  for (const discrepancy::CoveredPressures& one : gap.covered)
    covered.push_back({{"surface", one.surface}, {"pressure_pa", json(one.pressure)}});
  Json surfaces = Json::array();
  for (const discrepancy::SurfaceGap& one : gap.surfaces)
    surfaces.push_back({{"surface", one.surface}, {"before", one.before}, {"after", one.after}});
  return {{"unit", "fraction of full scale"},
          {"before", gap.before},
          {"before_interval", json(gap.before_interval)},
          {"after", gap.after},
          {"after_interval", json(gap.after_interval)},
          {"floor", gap.floor},
          {"floor_interval", json(gap.floor_interval)},
          {"floor_bracket", json(gap.floor_bracket)},
          {"closed", gap.closed},
          {"closed_interval", json(gap.closed_interval)},
          {"before_pa", gap.before_pressure},
          {"after_pa", gap.after_pressure},
          {"floor_pa", gap.floor_pressure},
          {"held_out_by", gap.held_out_by},
          {"surfaces", surfaces},
          {"covered", covered},
          {"left_out", gap.left_out},
          {"foretold", foretold},
          {"missing", gap.missing}};
}

Json json(const discrepancy::GapInUse& use) {
  return {{"situation", use.situation}, {"before_pa", use.before}, {"after_pa", use.after}};
}

Json json(const discrepancy::CandidateScore& candidate) {
  return {{"ids", candidate.ids},
          {"generic", candidate.generic},
          {"outcome", candidate.outcome},
          {"nats", candidate.nats},
          {"p", candidate.p},
          {"z", candidate.z},
          {"share_of_ceiling", candidate.share_of_explainable},
          {"at_map_pa", candidate.at_map}};
}

Json json(const discrepancy::SmallestSeen& seen) {
  return {{"id", seen.id}, {"at_map_pa", seen.at_map}};
}

Json json(const discrepancy::TooSmall& small) {
  return {{"explanation", small.explanation}, {"p", small.p}, {"at_map_pa", small.at_map}};
}

Json json(const discrepancy::Scatter& scatter) {
  return {{"part", scatter.part},
          {"unit", scatter.unit},
          {"size", scatter.size},
          {"interval", json(scatter.interval)},
          {"seen", scatter.seen()},
          {"at_map_pa", scatter.at_map},
          {"share_of_noise", scatter.of_noise}};
}

Json json(const discrepancy::Answer& answer) {
  return {{"id", answer.id},
          {"answer", answer.answer},
          {"at_map_pa", answer.at_map},
          {"sentence", answer.sentence}};
}

Json json(const FirstScreenItem& item) {
  return {{"title", item.title}, {"answer", item.answer}};
}

// The constants of the decision.
Json json(const discrepancy::DiscrepancyOptions& options) {
  return {{"level", options.level},
          {"credible", options.credible},
          {"least_gap_pa", options.least_gap},
          {"least_gap_share", options.least_gap_share},
          {"generic_better", options.generic_better},
          {"unknown_below", options.unknown_below},
          {"wrong_form_below", options.wrong_form_below},
          {"second_adds", options.second_adds},
          {"contender", options.contender},
          {"null_draws", options.null_draws},
          {"resamples", options.resamples},
          {"folds", options.folds},
          {"degrees", options.degrees}};
}

Json json(const discrepancy::NextExperiment& next) {
  return {{"protocol", next.protocol},
          {"sentence", next.sentence},
          {"separation", next.separation},
          {"cycles", next.cycles},
          {"separates", next.separates},
          {"certainty", next.certainty},
          {"entropy_before", next.entropy_before},
          {"entropy", next.entropy}};
}

std::vector<std::string> idsOf(const std::vector<simulation::EnabledEffect>& effects) {
  std::vector<std::string> ids;
  for (const simulation::EnabledEffect& effect : effects) ids.push_back(effect.id);
  return ids;
}

Json json(const discrepancy::Prediction& prediction) {
  if (prediction.effects.empty()) return nullptr;
  Json rivals = Json::array();
  for (const auto& rival : prediction.rivals) rivals.push_back(idsOf(rival));
  return {{"effects", idsOf(prediction.effects)},
          {"rivals", rivals},
          {"size", json(prediction.size)},
          {"weights", prediction.weights}};
}

Json json(const discrepancy::ResidualCurve& curve) {
  return {{"covariate", curve.covariate}, {"unit", curve.unit},   {"at", curve.at},
          {"before", curve.before},       {"after", curve.after}, {"error", curve.error}};
}

Json json(const discrepancy::InputUse& input) {
  return {{"file", input.file},
          {"sha256", input.sha256},
          {"scans", input.scans},
          {"show_opened", input.hold_out_opened}};
}

Json json(const discrepancy::RepeatStep& step) {
  return {{"added", step.added}, {"sentence", step.sentence}, {"at_map_pa", step.at_map}};
}

template <typename Items>
Json list(const Items& items) {
  Json array = Json::array();
  for (const auto& item : items) array.push_back(json(item));
  return array;
}

}  // namespace

Json discrepancyMembers(const discrepancy::DiscrepancyReport& report) {
  return {{"verdict", discrepancy::name(report.verdict)},
          {"sentence", report.sentence},
          {"first_screen", list(firstScreen(report))},
          {"effects", list(report.effects)},
          {"credible_set", report.credible_set},
          {"depends_on", report.depends_on},
          {"not_identifiable", list(report.not_identifiable)},
          {"covariates", list(report.covariates)},
          {"p", report.p},
          {"at_map_pa", report.at_map},
          {"least_gap_pa", report.least_gap},
          {"smallest_seen", list(report.smallest_seen)},
          {"too_small", list(report.too_small)},
          {"scatter", list(report.scatter)},
          {"answers", list(report.answers)},
          {"options", json(report.options)},
          {"where", json(report.where)},
          {"gap", json(report.gap)},
          {"recompute", report.recompute},
          {"map_gain", report.map_gain},
          {"in_use", list(report.in_use)},
          {"next_experiment",
           report.next_experiment.empty() ? Json(nullptr) : json(report.next_experiment.front())},
          {"candidates", list(report.candidates)},
          {"tested", report.tested},
          {"limitations", report.limitations},
          {"curves", list(report.curves)},
          {"steps", list(report.steps)},
          {"simulation", report.base.name},
          {"next_experiments", list(report.next_experiment)},
          {"prediction", json(report.prediction)},
          {"prediction_hash", report.prediction.hash},
          {"inputs", list(report.inputs)},
          {"seed", report.seed},
          {"version", report.version}};
}

std::string discrepancyJson(const discrepancy::DiscrepancyReport& report) {
  return dump(discrepancyMembers(report));
}

}  // namespace fsr::report
