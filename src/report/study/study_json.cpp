#include "report/calibration_report.h"
#include "report/study/study_members.h"
#include "report/study/study_report.h"

namespace fsr::report {

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

Json json(const statistics::BootstrapResult& interval) {
  return interval.method == statistics::IntervalMethod::kNone ? Json(nullptr) : resultOf(interval);
}

Json json(const study::StudyComparison& comparison) {
  Json differences = Json::array();
  for (const study::StudyDifference& difference : comparison.differences) {
    differences.push_back({{"first", difference.first},
                           {"second", difference.second},
                           {"rmse_percent", json(difference.rmse_percent)}});
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
          {"protocols", historyProtocolsJson(score)}};
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
         {"interval", json(result.headline.interval)}}},
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
