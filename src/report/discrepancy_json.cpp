#include "report/discrepancy_report.h"
#include "report/members_json.h"

namespace fsr::report {

// The members of results.json. They are found by their argument, so they are in no unnamed namespace.

static void members(MembersWriter& list, const discrepancy::FittedParameter& p) {
  list("name", p.name)("value", p.value)("unit", p.unit).pair("interval", p.interval.low, p.interval.high);
}

static void members(MembersWriter& list, const discrepancy::FoundEffect& effect) {
  list("id", effect.id)("summary", effect.summary)("parameters", effect.parameters)("z", effect.z);
  list("share_of_ceiling", effect.share_of_explainable);
}

static void members(MembersWriter& list, const discrepancy::NotIdentifiable& effect) {
  list("id", effect.id)("experiment", effect.experiment)("reason", effect.reason);
}

static void members(MembersWriter& list, const discrepancy::CovariateTest& test) {
  list("covariate", test.covariate)("method", test.method)("p", test.p)("adjusted_p", test.adjusted);
  list("at_map_pa", test.at_map)("depends", test.depends);
}

static void members(MembersWriter& list, const discrepancy::WhereItShows& where) {
  list("taxels", where.taxels)("conditions", where.conditions);
  list.pair("pressure_pa", where.pressure.low, where.pressure.high);
  list("direction", where.direction)("times_s", where.times);
}

static void members(MembersWriter& list, const discrepancy::HeldOutGap& held) {
  Json parts = Json::array();
  for (const auto& [part, closed] : held.parts) parts.push_back({{"part", part}, {"closed", closed}});
  list("by", held.by)("closed", held.closed);
  list.pair("closed_interval", held.closed_interval.low, held.closed_interval.high)("parts", parts);
}

static void members(MembersWriter& list, const discrepancy::CoveredPressures& one) {
  list("surface", one.surface).pair("pressure_pa", one.pressure.low, one.pressure.high);
}

static void members(MembersWriter& list, const discrepancy::SurfaceGap& one) {
  list("surface", one.surface)("before", one.before)("after", one.after);
}

static void members(MembersWriter& list, const discrepancy::Gap& gap) {
  const auto interval = [&](const char* name, const discrepancy::Interval& one) {
    list.pair(name, one.low, one.high);
  };
  list("unit", "fraction of full scale")("before", gap.before);
  interval("before_interval", gap.before_interval);
  list("after", gap.after);
  interval("after_interval", gap.after_interval);
  list("floor", gap.floor);
  interval("floor_interval", gap.floor_interval);
  interval("floor_bracket", gap.floor_bracket);
  list("closed", gap.closed);
  interval("closed_interval", gap.closed_interval);
  list("before_pa", gap.before_pressure)("after_pa", gap.after_pressure)("floor_pa", gap.floor_pressure);
  list("held_out_by", gap.held_out_by)("surfaces", gap.surfaces)("covered", gap.covered);
  list("left_out", gap.left_out)("foretold", gap.foretold)("missing", gap.missing);
}

static void members(MembersWriter& list, const discrepancy::GapInUse& use) {
  list("situation", use.situation)("before_pa", use.before)("after_pa", use.after);
}

static void members(MembersWriter& list, const discrepancy::CandidateScore& candidate) {
  list("ids", candidate.ids)("generic", candidate.generic)("outcome", candidate.outcome);
  list("nats", candidate.nats)("p", candidate.p)("z", candidate.z);
  list("share_of_ceiling", candidate.share_of_explainable)("at_map_pa", candidate.at_map);
}

static void members(MembersWriter& list, const discrepancy::SmallestSeen& seen) {
  list("id", seen.id)("at_map_pa", seen.at_map);
}

static void members(MembersWriter& list, const discrepancy::TooSmall& small) {
  list("explanation", small.explanation)("p", small.p)("at_map_pa", small.at_map);
  list("least_gap_pa", small.least_gap);
}

static void members(MembersWriter& list, const discrepancy::Scatter& scatter) {
  list("part", scatter.part)("unit", scatter.unit)("size", scatter.size);
  list.pair("interval", scatter.interval.low, scatter.interval.high)("seen", scatter.seen());
  list("at_map_pa", scatter.at_map)("share_of_noise", scatter.of_noise);
}

static void members(MembersWriter& list, const discrepancy::Answer& answer) {
  list("id", answer.id)("answer", answer.answer)("at_map_pa", answer.at_map)("sentence", answer.sentence);
}

static void members(MembersWriter& list, const FirstScreenItem& item) {
  list("title", item.title)("answer", item.answer);
}

// The constants of the decision.
static void members(MembersWriter& list, const discrepancy::DiscrepancyOptions& options) {
  list("level", options.level)("credible", options.credible)("least_gap_pa", options.least_gap);
  list("least_gap_share", options.least_gap_share)("generic_better", options.generic_better);
  list("unknown_below", options.unknown_below)("wrong_form_below", options.wrong_form_below);
  list("second_adds", options.second_adds)("contender", options.contender);
  list("null_draws", options.null_draws)("resamples", options.resamples)("folds", options.folds);
  list("degrees", options.degrees);
}

static void members(MembersWriter& list, const discrepancy::NextExperiment& next) {
  list("protocol", next.protocol)("sentence", next.sentence)("separation", next.separation);
  list("cycles", next.cycles)("separates", next.separates)("certainty", next.certainty);
  list("entropy_before", next.entropy_before)("entropy", next.entropy);
}

static void members(MembersWriter& list, const discrepancy::ResidualCurve& curve) {
  list("covariate", curve.covariate)("unit", curve.unit)("at", curve.at)("before", curve.before);
  list("after", curve.after)("error", curve.error);
}

static void members(MembersWriter& list, const discrepancy::InputUse& input) {
  list("file", input.file)("sha256", input.sha256)("scans", input.scans);
  list("show_opened", input.hold_out_opened);
}

static void members(MembersWriter& list, const discrepancy::RepeatStep& step) {
  list("added", step.added)("sentence", step.sentence)("at_map_pa", step.at_map);
}

namespace {

std::vector<std::string> idsOf(const std::vector<simulation::EnabledEffect>& effects) {
  std::vector<std::string> ids;
  for (const simulation::EnabledEffect& effect : effects) ids.push_back(effect.id);
  return ids;
}

Json predictionMembers(const discrepancy::Prediction& prediction) {
  if (prediction.effects.empty()) return nullptr;
  Json rivals = Json::array();
  for (const auto& rival : prediction.rivals) rivals.push_back(idsOf(rival));
  return {{"effects", idsOf(prediction.effects)},
          {"rivals", rivals},
          {"size", Json::array({prediction.size.low, prediction.size.high})},
          {"weights", prediction.weights}};
}

}  // namespace

Json discrepancyMembers(const discrepancy::DiscrepancyReport& report) {
  MembersWriter list;
  const auto& next = report.next_experiment;
  list("verdict", discrepancy::name(report.verdict))("sentence", report.sentence);
  list("first_screen", firstScreen(report))("effects", report.effects);
  list("credible_set", report.credible_set)("depends_on", report.depends_on);
  list("not_identifiable", report.not_identifiable)("covariates", report.covariates)("p", report.p);
  list("at_map_pa", report.at_map)("least_gap_pa", report.least_gap);
  list("smallest_seen", report.smallest_seen)("too_small", report.too_small)("scatter", report.scatter);
  list("answers", report.answers)("options", report.options)("where", report.where)("gap", report.gap);
  list("recompute", report.recompute)("map_gain", report.map_gain)("in_use", report.in_use);
  list("next_experiment", next.empty() ? Json(nullptr) : resultOf(next.front()));
  list("candidates", report.candidates)("tested", report.tested)("limitations", report.limitations);
  list("curves", report.curves)("steps", report.steps)("simulation", report.base.name);
  list("next_experiments", next)("prediction", predictionMembers(report.prediction));
  list("prediction_hash", report.prediction.hash)("inputs", report.inputs)("seed", report.seed);
  return list("version", report.version).object;
}

std::string discrepancyJson(const discrepancy::DiscrepancyReport& report) {
  return dump(discrepancyMembers(report));
}

}  // namespace fsr::report
