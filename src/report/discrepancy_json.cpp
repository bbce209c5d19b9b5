#include <nlohmann/json.hpp>

#include "report/discrepancy_report.h"

namespace fsr::report {

namespace {

using Json = nlohmann::ordered_json;  // NaN is written as null

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
  return {{"covariate", test.covariate},
          {"method", test.method},
          {"p", test.p},
          {"adjusted_p", test.adjusted},
          {"share_of_error", test.share_of_error},
          {"depends", test.depends}};
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
          {"outcome", candidate.outcome},
          {"share_of_error", candidate.share_of_error},
          {"share_of_ceiling", candidate.share_of_explainable},
          {"z", candidate.z}};
}

Json json(const discrepancy::NextExperiment& next) {
  return {{"protocol", next.protocol},
          {"sentence", next.sentence},
          {"separation", next.separation},
          {"separates", next.separates}};
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
  return {{"added", step.added}, {"sentence", step.sentence}, {"share_of_error", step.share_of_error}};
}

template <typename Items>
Json list(const Items& items) {
  Json array = Json::array();
  for (const auto& item : items) array.push_back(json(item));
  return array;
}

}  // namespace

std::string discrepancyJson(const discrepancy::DiscrepancyReport& report) {
  const Json all = {{"verdict", discrepancy::name(report.verdict)},
                    {"sentence", report.sentence},
                    {"effects", list(report.effects)},
                    {"credible_set", report.credible_set},
                    {"depends_on", report.depends_on},
                    {"not_identifiable", list(report.not_identifiable)},
                    {"covariates", list(report.covariates)},
                    {"where", json(report.where)},
                    {"gap", json(report.gap)},
                    {"recompute", report.recompute},
                    {"in_use", list(report.in_use)},
                    {"next_experiment",
                     report.next_experiment.empty() ? Json(nullptr) : json(report.next_experiment.front())},
                    {"candidates", list(report.candidates)},
                    {"tested", report.tested},
                    {"limitations", report.limitations},
                    {"curves", list(report.curves)},
                    {"steps", list(report.steps)},
                    {"simulation", report.base.name},
                    {"prediction_hash", report.prediction.hash},
                    {"inputs", list(report.inputs)},
                    {"seed", report.seed},
                    {"version", report.version}};
  return all.dump(2) + "\n";
}

}  // namespace fsr::report
