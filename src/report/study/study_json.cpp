#include <cmath>

#include "report/history_report.h"
#include "report/result_json.h"
#include "report/study/study_report.h"
#include "study/paper.h"

namespace fsr::report {

namespace {

using report::json;  // the overloads of result_json.h

using report::json;  // the overloads of result_json.h

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
  if (interval.method == statistics::IntervalMethod::kNone) return nullptr;
  return {{"estimate", interval.estimate},
          {"interval_95", Json::array({interval.low, interval.high})},
          {"method", interval.method == statistics::IntervalMethod::kBca ? "BCa" : "t"},
          {"unit", interval.level},
          {"n", interval.units}};
}

Json paper(const std::string& method) {
  const auto score = study::paperScore(method);
  if (!score) return nullptr;
  return {{"r2", json(score->r2)}, {"rmse_percent", json(score->rmse_percent)}};
}

Json json(const study::StudyScore& score) {
  return {{"id", score.id},
          {"label", score.label},
          {"model", score.model},
          {"scored", score.scored},
          {"scans", score.scans},
          {"r2", json(score.r2_spread)},
          {"rmse_percent", json(score.rmse_percent_spread)},
          {"paper", score.model == "grnn" ? paper(score.id == "grnn" ? "baseline" : score.id) : nullptr},
          {"rmse_percent_interval", json(score.rmse_percent_interval)},
          {"rmse_pa_interval", json(score.rmse_interval)},
          {"worst_taxel", score.worst_taxel},
          {"worst_rmse_percent", score.worst_rmse_percent},
          {"errors_pa", json(score.errors)},
          {"first_cycle_pa", json(score.first_cycle)},
          {"later_cycles_pa", json(score.later_cycles)},
          {"bandwidth", score.bandwidth},
          {"taxels", {{"r2", score.r2}, {"rmse_percent", score.rmse_percent}}}};
}

Json json(const std::vector<study::StudyScore>& scores) {
  Json list = Json::array();
  for (const study::StudyScore& score : scores) list.push_back(json(score));
  return list;
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
          {"scores", json(comparison.scores)},
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

Json conditionsJson(const study::StudyResult& result) {
  Json list = Json::array();
  for (const study::StudyClass& row : result.classes) {
    list.push_back({{"surface", row.condition.surface},
                    {"curvature", row.condition.curvature},
                    {"scans", row.scans},
                    {"cycles", row.cycles},
                    {"mounts", row.mounts}});
  }
  return list;
}

Json bandwidthsJson(const study::StudyResult& result) {
  Json curves = Json::array();
  for (const study::BandwidthCurve& curve : result.bandwidths) {
    curves.push_back({{"id", curve.id}, {"label", curve.label}, {"rmse_percent", curve.rmse_percent}});
  }
  return {{"bandwidths", result.plan.bandwidths}, {"curves", curves}};
}

Json splitsJson(const study::StudyResult& result) {
  Json list = Json::array();
  for (const study::SplitResult& split : result.splits) {
    list.push_back({{"id", split.id},
                    {"description", split.description},
                    {"folds", split.folds},
                    {"scores", json(split.scores)}});
  }
  return list;
}

Json historyChoiceJson(const calibration::HistoryScore& score) {
  if (score.choice.empty()) return nullptr;
  return {{"assessable", !score.protocols.empty()},
          {"choice", score.choice},
          {"protocols", historyProtocolsJson(score)}};
}

// Scores of each error of curvature.
Json json(const study::CurvatureErrorCurve& curve) {
  Json list = Json::array();
  for (const study::CurvatureErrorScore& score : curve.scores) {
    list.push_back({{"relative", score.error.relative},
                    {"absolute", score.error.absolute},
                    {"rmse_percent", score.rmse_percent},
                    {"rmse_pa", score.rmse},
                    {"rmse_pa_interval", json(score.rmse_interval)},
                    {"rmse_pa_of_condition", score.rmse_of_class},
                    {"moved_pa", score.moved},
                    {"stated_pa", score.stated}});
  }
  return {{"id", curve.id}, {"label", curve.label}, {"scores", list}};
}

Json curvatureErrorsJson(const study::StudyResult& result) {
  Json list = Json::array();
  for (const study::CurvatureErrorCurve& curve : result.curvature_errors) list.push_back(json(curve));
  return list;
}

Json decisionsJson(const study::StudyResult& result) {
  Json list = Json::array();
  for (const study::StudyDecision& decision : result.decisions) {
    list.push_back({{"subject", decision.subject}, {"paper", decision.paper}, {"study", decision.study}});
  }
  return list;
}

}  // namespace

std::string studyJson(const study::StudyResult& result) {
  return dump({{"study", result.plan.name},
               {"headline",
                {{"text", result.headline.text},
                 {"split", result.headline.split},
                 {"method", result.headline.method},
                 {"rmse_pa", result.headline.rmse},
                 {"interval", json(result.headline.interval)}}},
               {"simulation", result.simulation.empty() ? Json(nullptr) : Json(result.simulation)},
               {"holds_for", result.holds_for},
               {"sensor", json(result.sensor)},
               {"layout", {{"rows", result.layout.size.rows}, {"columns", result.layout.size.columns}}},
               {"scans", result.scans},
               {"cycles", result.cycles},
               {"mounts", result.mounts},
               {"taxels", result.taxels},
               {"conditions", conditionsJson(result)},
               {"plan", planJson(result.plan)},
               {"provenance", json(result.provenance)},
               {"warnings", result.warnings},
               {"comparisons",
                [&] {
                  Json list = Json::array();
                  for (const study::StudyComparison& comparison : result.comparisons)
                    list.push_back(json(comparison));
                  return list;
                }()},
               {"bandwidth_grid", bandwidthsJson(result)},
               {"splits", splitsJson(result)},
               {"history", historyChoiceJson(result.history)},
               {"curvature_errors", curvatureErrorsJson(result)},
               {"figure_taxel", result.response.taxel},
               {"decisions", decisionsJson(result)},
               {"unmatchable", result.unmatchable}});
}

}  // namespace fsr::report
