#include "regression/regressors.h"
#include "report/budget_report.h"
#include "report/calibration_report.h"
#include "report/good_for.h"
#include "report/history_report.h"
#include "report/result_json.h"
#include "report/session_report.h"

namespace fsr::report {

namespace {

using report::json;  // the overloads of result_json.h

Json json(const calibration::TrainedInterval& interval) {
  return Json::array({interval.low, interval.high});
}

Json json(const calibration::Score& score) {
  return {{"readings", score.readings},
          {"r2", json(score.r2)},
          {"rmse_percent", json(score.rmse_percent)},
          {"worst_taxel", score.worst_taxel},
          {"worst_rmse_percent", score.worst_rmse_percent},
          {"within_one_deviation", score.within_one_deviation},
          {"errors_pa", json(score.errors)}};
}

Json json(const calibration::CalibrationScores& scores) {
  if (scores.conditions.empty()) return nullptr;
  Json conditions = Json::array();
  for (const calibration::ConditionScore& condition : scores.conditions) {
    Json row = {{"surface", condition.condition.surface},
                {"curvature", condition.condition.curvature},
                {"trained", condition.trained}};
    row.update(json(condition.score));
    conditions.push_back(row);
  }
  return {{"conditions", conditions},
          {"whole", json(scores.whole)},
          {"unseen_curvature",
           {{"readings", scores.unseen.readings},
            {"rmse", scores.unseen.rmse},
            {"rmse_percent_mean", scores.unseen.rmse_percent.mean},
            {"rmse_percent_deviation", scores.unseen.rmse_percent.deviation}}},
          {"another_mount",
           {{"readings", scores.remount.readings},
            {"rmse", scores.remount.rmse},
            {"rmse_percent_mean", scores.remount.rmse_percent.mean},
            {"rmse_percent_deviation", scores.remount.rmse_percent.deviation}}}};
}

Json json(const std::array<dataset::CoverageCell, statistics::kPressureBins>& cells) {
  Json bins = Json::object();
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
    bins[statistics::pressureBinName(bin) + " kPa"] = {{"scans", cells[bin].scans},
                                                       {"cycles", cells[bin].cycles}};
  }
  return bins;
}

Json json(const dataset::Coverage& coverage) {
  Json conditions = Json::array();
  for (const dataset::ConditionCoverage& row : coverage.conditions) {
    conditions.push_back({{"surface", row.condition.surface},
                          {"curvature", row.condition.curvature},
                          {"scans", row.scans},
                          {"cycles", row.cycles},
                          {"pressure", Json::array({row.pressure_low, row.pressure_high})},
                          {"loading", json(row.loading)},
                          {"unloading", json(row.unloading)}});
  }
  return {{"conditions", conditions}, {"thin", coverage.thin}};
}

// The options that the model uses.
Json model(const calibration::Calibration& calibration) {
  const regression::RegressorOptions& options = calibration.regressor;
  Json model = {{"name", options.name}};
  if (options.name == "grnn") {
    model["bandwidth"] = options.grnn.bandwidth;
    model["bandwidth_chosen"] = calibration.bandwidth_chosen;
    model["spread"] = regression::spreadName(options.grnn.spread);
    model["distance"] = regression::distanceName(options.grnn.distance);
    model["weighting"] = regression::weightingName(options.grnn.weighting);
  } else if (options.name == "forest") {
    model["trees"] = options.forest.trees;
    model["minimum_leaf"] = options.forest.minimum_leaf;
    model["leaf_rule"] = regression::leafRuleName(options.forest.leaf_count);
  }
  return model;
}

Json json(const calibration::Correction& correction) {
  if (!correction.present()) return nullptr;
  Json bags = Json::array();
  for (const calibration::SourceBag& bag : correction.bags)
    bags.push_back({{"name", bag.name}, {"sha256", bag.sha256}, {"scans", bag.scans}});
  return {{"parent", correction.parent},
          {"parent_date", correction.parent_date},
          {"date", correction.date},
          {"by_taxel", correction.by_taxel},
          {"gain", correction.gain},
          {"offset_counts", correction.offset},
          {"surfaces", correction.surfaces},
          {"bags", bags},
          {"cycles", correction.cycles},
          {"expected_rmse", correction.expected_rmse},
          {"rmse_before", correction.rmse_before},
          {"rmse", correction.rmse}};
}

}  // namespace

std::string calibrationJson(const calibration::Calibration& calibration) {
  const matrix::Layout& layout = calibration.layout;
  const calibration::TrainedRanges& trained = calibration.trained;
  const Json document = {{"id", calibration.id},
                         {"good_for", goodForText(calibration)},
                         {"scheme", compensation::schemeName(calibration.tables.scheme)},
                         {"model", model(calibration)},
                         {"scheme_in_paper", compensation::schemeInPaper(calibration.tables.scheme)},
                         {"length_scale", calibration.tables.rule.length_scale},
                         {"model_of_class", calibration.tables.rule.model_of_class},
                         {"folds", calibration.folds},
                         {"sensor", json(calibration.sensor)},
                         {"layout",
                          {{"rows", layout.size.rows},
                           {"columns", layout.size.columns},
                           {"pitch_x", layout.pitch_x},
                           {"pitch_y", layout.pitch_y},
                           {"full_scale", calibration.tables.full_scale}}},
                         {"trained",
                          {{"pressure", json(trained.pressure)},
                           {"pressure_rate", json(trained.pressure_rate)},
                           {"curvature", json(trained.curvature)},
                           {"temperature", json(trained.temperature)}}},
                         {"provenance", json(calibration.provenance)},
                         {"correction", json(calibration.correction)},
                         {"warnings", calibration.warnings},
                         {"coverage", json(calibration.coverage)},
                         {"scores", json(calibration.scores)},
                         {"history", historyJson(calibration)},
                         {"session", sessionJson(calibration)},
                         {"temperature", temperatureJson(calibration)},
                         {"error_budget", budgetJson(calibration.budget)}};
  return dump(document);
}

}  // namespace fsr::report
