#pragma once

#include <string>
#include <type_traits>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/members_json.h"
#include "study/paper.h"
#include "study/study_pieces.h"

// The members of a study: of results.json, and of the file of a shard. See members_json.h.
namespace fsr::report {

/// What the paper found with a method; null = nothing.
inline Json paperMembers(const study::StudyScore& score) {
  if (score.model != "grnn") return nullptr;
  const auto paper = study::paperScore(score.id == "grnn" ? "baseline" : score.id);
  if (!paper) return nullptr;
  return {{"r2", resultOf(paper->r2)}, {"rmse_percent", resultOf(paper->rmse_percent)}};
}

template <typename List>
void members(List& list, statistics::BootstrapResult& interval) {
  list("estimate", interval.estimate).pair("interval_95", interval.low, interval.high);
  list.exact("interval_method", interval.method).exact("standard_error", interval.standard_error);
  list.result("method", interval.method == statistics::IntervalMethod::kBca ? "BCa" : "t");
  list("unit", interval.level)("n", interval.units).exact("resamples", interval.resamples);
}

// Null in results where there is none.
template <typename List>
void intervalMembers(List& list, const std::string& key, statistics::BootstrapResult& interval) {
  if (list.forResults() && interval.method == statistics::IntervalMethod::kNone) {
    list.result(key, nullptr);
  } else {
    list(key, interval);
  }
}

template <typename List>
void members(List& list, study::StudyScore& score) {
  list("id", score.id)("label", score.label)("model", score.model)("scored", score.scored);
  list("scans", score.scans)("r2", score.r2_spread)("rmse_percent", score.rmse_percent_spread);
  list.result("paper", paperMembers(score));
  intervalMembers(list, "rmse_percent_interval", score.rmse_percent_interval);
  intervalMembers(list, "rmse_pa_interval", score.rmse_interval);
  list("worst_taxel", score.worst_taxel)("worst_rmse_percent", score.worst_rmse_percent);
  list("errors_pa", score.errors)("first_cycle_pa", score.first_cycle);
  list("later_cycles_pa", score.later_cycles)("bandwidth", score.bandwidth);
  list.under("taxels", [&](auto& taxels) { taxels("r2", score.r2)("rmse_percent", score.rmse_percent); });
}

template <typename List>
void members(List& list, study::StudyClass& row) {
  list("surface", row.condition.surface)("curvature", row.condition.curvature)("scans", row.scans);
  list("cycles", row.cycles)("mounts", row.mounts);
}

template <typename List>
void members(List& list, study::StudyDecision& decision) {
  list("subject", decision.subject)("paper", decision.paper)("study", decision.study);
}

template <typename List>
void members(List& list, study::BandwidthCurve& curve) {
  list("id", curve.id)("label", curve.label)("rmse_percent", curve.rmse_percent);
}

template <typename List>
void members(List& list, study::SplitResult& split) {
  list("id", split.id)("description", split.description)("folds", split.folds)("scores", split.scores);
}

template <typename List>
void members(List& list, study::CurvatureErrorScore& score) {
  list("relative", score.error.relative)("absolute", score.error.absolute);
  list("rmse_percent", score.rmse_percent)("rmse_pa", score.rmse);
  intervalMembers(list, "rmse_pa_interval", score.rmse_interval);
  list("rmse_pa_of_condition", score.rmse_of_class)("moved_pa", score.moved)("stated_pa", score.stated);
}

template <typename List>
void members(List& list, study::CurvatureErrorCurve& curve) {
  list("id", curve.id)("label", curve.label)("scores", curve.scores);
}

// What follows is in the file of a shard only.

// Without the number of threads, which changes no number, and the date, which stands in the provenance.
template <typename List>
void members(List& list, study::StudyPlan& plan) {
  list("study", plan.name)("sections", plan.sections)("down_sampling", plan.down_sampling);
  list("method_4", plan.binary_share)("range", plan.range)("grnn", plan.grnn)("forest", plan.forest);
  list("tests", plan.tests)("bandwidths", plan.bandwidths)("bandwidth_taxels", plan.bandwidth_taxels);
  list("resamples", plan.resamples)("beyond_the_paper", plan.beyond_the_paper);
  list("figure_taxel", plan.figure_taxel)("seed", plan.seed);
}

template <typename List>
void members(List& list, regression::GrnnOptions& grnn) {
  list("bandwidth", grnn.bandwidth)("spread", grnn.spread)("distance", grnn.distance);
  list("weighting", grnn.weighting);
}

template <typename List>
void members(List& list, regression::ForestOptions& forest) {
  list("trees", forest.trees)("minimum_leaf", forest.minimum_leaf)("leaf_count", forest.leaf_count);
  list("sampling", forest.sampling)("seed", forest.seed);
}

template <typename List>
void members(List& list, statistics::PaperRuleOptions& tests) {
  list("level", tests.level)("normality_of", tests.normality);
}

template <typename List>
void members(List& list, calibration::HistoryScore& score) {
  list("choice", score.choice)("protocols", score.protocols)("parts", score.parts);
}

template <typename List>
void members(List& list, study::TaxelResponse::Curve& curve) {
  list("surface", curve.surface)("curvature", curve.curvature)("time", curve.time);
  list("pressure", curve.pressure)("counts", curve.counts);
}

template <typename List>
void members(List& list, study::TaxelResponse::Prediction& prediction) {
  list("surface", prediction.surface)("curvature", prediction.curvature)("time", prediction.time);
  list("reference", prediction.reference)("without_curvature", prediction.without_curvature);
  list("with_curvature", prediction.with_curvature);
}

template <typename List>
void members(List& list, study::TaxelResponse& response) {
  list("taxel", response.taxel)("curves", response.curves)("prediction", response.prediction);
}

// What the pieces tell is empty in the frame, and not stored.
template <typename List>
void members(List& list, study::StudyResult& result) {
  list("plan", result.plan)("simulation", result.simulation)("provenance", result.provenance);
  list("sensor", result.sensor)("layout", result.layout)("classes", result.classes)("scans", result.scans);
  list("cycles", result.cycles)("mounts", result.mounts)("taxels", result.taxels)("splits", result.splits);
  list("history", result.history)("decisions", result.decisions)("unmatchable", result.unmatchable);
  list("holds_for", result.holds_for)("warnings", result.warnings);
}

template <typename List>
void members(List& list, study::CycleSums::Values& sums) {
  list("taxels", sums.taxels)("models", sums.models)("cycles", sums.cycles)("range", sums.range);
  list("squares", sums.squares)("readings", sums.readings);
}

template <typename List>
void members(List& list, study::CycleUnits& units) {
  list("mount", units.mount)("by_mount", units.by_mount);
}

template <typename List>
void members(List& list, study::ScoredMethod& method) {
  if constexpr (std::is_same_v<List, MembersReader>) {
    study::CycleSums::Values sums;
    list("score", method.score)("sums", sums);
    const std::size_t models = sums.cycles * sums.models;
    if (sums.readings.size() != models || sums.squares.size() != models * sums.taxels)
      throw settings::InputError("sums of another size");
    method.sums = study::CycleSums(std::move(sums));
  } else {
    list("score", method.score)("sums", method.sums.values());
  }
}

template <typename List>
void members(List& list, study::StudyPiece& piece) {
  list("part", piece.part)("compared", piece.compared)("bandwidths", piece.bandwidths);
  list("held_out", piece.held_out)("with_history", piece.with_history)("history", piece.history);
  list("curvature_errors", piece.curvature_errors)("response", piece.response);
}

template <typename List>
void members(List& list, study::StudyParts& parts) {
  list("frame", parts.frame)("units", parts.units)("pieces_of_study", parts.pieces_of_study);
}

}  // namespace fsr::report
