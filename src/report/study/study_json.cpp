#include <string>

#include "report/members_json.h"
#include "report/study/study_report.h"
#include "study/paper.h"

namespace fsr::report {

// The members of a study. See members_json.h.

// What the paper found with a method; null = nothing.
static Json paperMembers(const study::StudyScore& score) {
  if (score.model != "grnn") return nullptr;
  const auto paper = study::paperScore(score.id == "grnn" ? "baseline" : score.id);
  if (!paper) return nullptr;
  return {{"r2", resultOf(paper->r2)}, {"rmse_percent", resultOf(paper->rmse_percent)}};
}

static void members(MembersWriter& list, const statistics::BootstrapResult& interval) {
  list("estimate", interval.estimate).pair("interval_95", interval.low, interval.high);
  list("method", interval.method == statistics::IntervalMethod::kBca ? "BCa" : "t");
  list("unit", interval.level)("n", interval.units);
}

// Null where there is none.
static Json intervalJson(const statistics::BootstrapResult& interval) {
  return interval.method == statistics::IntervalMethod::kNone ? Json(nullptr) : resultOf(interval);
}

static void members(MembersWriter& list, const study::StudyScore& score) {
  list("id", score.id)("label", score.label)("model", score.model)("scored", score.scored);
  list("scans", score.scans)("r2", score.r2_spread)("rmse_percent", score.rmse_percent_spread);
  list("paper", paperMembers(score));
  list("rmse_percent_interval", intervalJson(score.rmse_percent_interval));
  list("rmse_pa_interval", intervalJson(score.rmse_interval));
  list("worst_taxel", score.worst_taxel)("worst_rmse_percent", score.worst_rmse_percent);
  list("errors_pa", score.errors)("first_cycle_pa", score.first_cycle);
  list("later_cycles_pa", score.later_cycles)("bandwidth", score.bandwidth);
  list.under("taxels",
             [&](MembersWriter& taxels) { taxels("r2", score.r2)("rmse_percent", score.rmse_percent); });
}

static void members(MembersWriter& list, const study::StudyClass& row) {
  list("surface", row.condition.surface)("curvature", row.condition.curvature)("scans", row.scans);
  list("cycles", row.cycles)("mounts", row.mounts);
}

static void members(MembersWriter& list, const study::StudyDecision& decision) {
  list("subject", decision.subject)("paper", decision.paper)("study", decision.study);
}

static void members(MembersWriter& list, const study::BandwidthCurve& curve) {
  list("id", curve.id)("label", curve.label)("rmse_percent", curve.rmse_percent);
}

static void members(MembersWriter& list, const study::SplitResult& split) {
  list("id", split.id)("description", split.description)("folds", split.folds)("scores", split.scores);
}

static void members(MembersWriter& list, const study::CurvatureErrorScore& score) {
  list("relative", score.error.relative)("absolute", score.error.absolute);
  list("rmse_percent", score.rmse_percent)("rmse_pa", score.rmse);
  list("rmse_pa_interval", intervalJson(score.rmse_interval));
  list("rmse_pa_of_condition", score.rmse_of_class)("moved_pa", score.moved)("stated_pa", score.stated);
}

static void members(MembersWriter& list, const study::CurvatureErrorCurve& curve) {
  list("id", curve.id)("label", curve.label)("scores", curve.scores);
}

namespace {

Json json(const statistics::TestResult& test) {
  return {{"test", test.test},
          {"symbol", test.symbol},
          {"statistic", test.statistic},
          {"degrees_of_freedom", test.degrees_of_freedom},
          {"p", test.p},
          {"n", test.n},
          {"method", statistics::pMethodName(test.method)}};
}

Json json(const statistics::PaperRuleResult& rule, const std::vector<study::StudyScore>& scores) {
  Json decisions = Json::array(), pairs = Json::array();
  for (const statistics::Decision& decision : rule.decisions) {
    decisions.push_back(
        {{"subject", decision.subject}, {"test", json(decision.test)}, {"conclusion", decision.conclusion}});
  }
  for (const statistics::PairComparison& pair : rule.pairs) {
    pairs.push_back({{"first", scores[pair.first].label},
                     {"second", scores[pair.second].label},
                     {"test", json(pair.test)},
                     {"adjusted_p", pair.adjusted_p},
                     {"differ", pair.differ}});
  }
  return {{"test", json(rule.test)},
          {"p", rule.p},
          {"differ", rule.differ},
          {"decisions", decisions},
          {"pairs", pairs}};
}

Json json(const study::StudyComparison& comparison) {
  Json differences = Json::array();
  for (const study::StudyDifference& difference : comparison.differences) {
    differences.push_back({{"first", difference.first},
                           {"second", difference.second},
                           {"rmse_percent", intervalJson(difference.rmse_percent)}});
  }
  const study::PaperFriedman friedman = study::paperFriedman(comparison.id);
  return {{"id", comparison.id},
          {"title", comparison.title},
          {"scores", resultOf(comparison.scores)},
          {"as_published_taxels_treated_as_independent",
           {{"r2", json(comparison.r2, comparison.scores)},
            {"rmse_percent", json(comparison.rmse_percent, comparison.scores)}}},
          {"differences_of_rmse_percent", differences},
          {"paper",
           {{"friedman_r2", friedman.r2},
            {"friedman_rmse_percent", friedman.rmse_percent},
            {"statements", study::paperStatements(comparison.id)}}}};
}

Json planJson(const study::StudyPlan& plan) {
  return {{"name", plan.name},
          {"sections", plan.sections},
          {"down_sampling", study::downSamplingName(plan.down_sampling)},
          {"method_4", plan.binary_share == study::BinaryShare::kFullFlat ? "full_flat" : "half_and_half"},
          {"range", plan.range == study::ScoreRange::kHeldOut ? "held_out" : "all"},
          {"bandwidth", plan.grnn.bandwidth},
          {"spread", plan.grnn.spread == regression::SpreadMeaning::kSigma ? "sigma" : "half"},
          {"distance", plan.grnn.distance == regression::KernelDistance::kSquared ? "squared" : "literal"},
          {"trees", plan.forest.trees},
          {"minimum_leaf", plan.forest.minimum_leaf},
          {"level", plan.tests.level},
          {"bandwidth_taxels", plan.bandwidth_taxels},
          {"resamples", plan.resamples},
          {"beyond_the_paper", plan.beyond_the_paper},
          {"seed", plan.seed}};
}

Json historyChoiceJson(const calibration::HistoryScore& score) {
  if (score.choice.empty()) return nullptr;
  return {{"assessable", !score.protocols.empty()},
          {"choice", score.choice},
          {"protocols", resultOf(score.protocols)}};
}

}  // namespace

std::string studyJson(const study::StudyResult& result) {
  Json comparisons = Json::array();
  for (const study::StudyComparison& comparison : result.comparisons) comparisons.push_back(json(comparison));
  return dump(
      {{"study", result.plan.name},
       {"headline",
        {{"text", result.headline.text},
         {"split", result.headline.split},
         {"method", result.headline.method},
         {"rmse_pa", result.headline.rmse},
         {"interval", intervalJson(result.headline.interval)}}},
       {"simulation", result.simulation.empty() ? Json(nullptr) : Json(result.simulation)},
       {"holds_for", result.holds_for},
       {"sensor", resultOf(result.sensor)},
       {"layout", {{"rows", result.layout.size.rows}, {"columns", result.layout.size.columns}}},
       {"scans", result.scans},
       {"cycles", result.cycles},
       {"mounts", result.mounts},
       {"taxels", result.taxels},
       {"conditions", resultOf(result.classes)},
       {"plan", planJson(result.plan)},
       {"provenance", resultOf(result.provenance)},
       {"warnings", result.warnings},
       {"comparisons", comparisons},
       {"bandwidth_grid", {{"bandwidths", result.plan.bandwidths}, {"curves", resultOf(result.bandwidths)}}},
       {"splits", resultOf(result.splits)},
       {"history", historyChoiceJson(result.history)},
       {"curvature_errors", resultOf(result.curvature_errors)},
       {"figure_taxel", result.response.taxel},
       {"decisions", resultOf(result.decisions)},
       {"unmatchable", result.unmatchable}});
}

}  // namespace fsr::report
