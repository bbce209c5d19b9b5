#include <nlohmann/json.hpp>

#include "fsr_pressure_map/regression/option_names.h"
#include "fsr_pressure_map/report/calibration_report.h"

namespace fsr {

namespace {

using Json = nlohmann::ordered_json;  // NaN is written as null

Json json(const Spread& spread) {
  return {{"mean", spread.mean}, {"deviation", spread.deviation}};
}

Json json(const TrainedInterval& interval) {
  return Json::array({interval.low, interval.high});
}

Json json(const ErrorSummary& errors) {
  return {{"count", errors.count},
          {"bias", errors.bias},
          {"rmse", errors.rmse},
          {"limits_95", Json::array({errors.limit_low, errors.limit_high})},
          {"p95_absolute", errors.p95_absolute}};
}

Json json(const BinnedErrors::Directions& errors) {
  return {
      {"all", json(errors.all)}, {"loading", json(errors.loading)}, {"unloading", json(errors.unloading)}};
}

Json json(const Score& score) {
  Json bins = Json::object();
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
    bins[pressureBinName(bin) + " kPa"] = json(score.errors.bins[bin]);
  }
  return {{"readings", score.readings},
          {"r2", json(score.r2)},
          {"rmse_percent", json(score.rmse_percent)},
          {"worst_taxel", score.worst_taxel},
          {"worst_rmse_percent", score.worst_rmse_percent},
          {"within_one_deviation", score.within_one_deviation},
          {"errors_pa", {{"whole", json(score.errors.whole)}, {"bins", bins}}}};
}

Json json(const CalibrationScores& scores) {
  if (scores.conditions.empty()) return nullptr;
  Json conditions = Json::array();
  for (const ConditionScore& condition : scores.conditions) {
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
            {"rmse_percent_deviation", scores.unseen.rmse_percent.deviation}}}};
}

Json json(const std::array<CoverageCell, kPressureBins>& cells) {
  Json bins = Json::object();
  for (std::size_t bin = 0; bin < kPressureBins; ++bin) {
    bins[pressureBinName(bin) + " kPa"] = {{"scans", cells[bin].scans}, {"cycles", cells[bin].cycles}};
  }
  return bins;
}

Json json(const Coverage& coverage) {
  Json conditions = Json::array();
  for (const ConditionCoverage& row : coverage.conditions) {
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

Json json(const SensorIdentity& sensor) {
  return {{"sensor_id", sensor.sensor_id}, {"serial", sensor.serial},   {"firmware", sensor.firmware},
          {"model", sensor.model},         {"sealing", sensor.sealing}, {"transducer", sensor.transducer}};
}

Json json(const Provenance& provenance) {
  Json bags = Json::array();
  for (const SourceBag& bag : provenance.bags) {
    bags.push_back({{"name", bag.name}, {"sha256", bag.sha256}, {"scans", bag.scans}});
  }
  return {{"tool_version", provenance.tool_version},
          {"date", provenance.date},
          {"seed", provenance.seed},
          {"bags", bags}};
}

// Only what the model looks at.
Json model(const Calibration& calibration) {
  const RegressorOptions& options = calibration.regressor;
  Json model = {{"name", options.name}};
  if (options.name == "grnn") {
    model["bandwidth"] = options.grnn.bandwidth;
    model["bandwidth_chosen"] = calibration.bandwidth_chosen;
    model["spread"] = spreadName(options.grnn.spread);
    model["distance"] = distanceName(options.grnn.distance);
    model["weighting"] = weightingName(options.grnn.weighting);
  } else if (options.name == "forest") {
    model["trees"] = options.forest.trees;
    model["minimum_leaf"] = options.forest.minimum_leaf;
    model["leaf_rule"] = leafRuleName(options.forest.leaf_count);
  }
  return model;
}

}  // namespace

std::string calibrationJson(const Calibration& calibration) {
  const Layout& layout = calibration.layout;
  const TrainedRanges& trained = calibration.trained;
  const Json document = {{"id", calibration.id},
                         {"scheme", schemeName(calibration.tables.scheme)},
                         {"model", model(calibration)},
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
                         {"warnings", calibration.warnings},
                         {"coverage", json(calibration.coverage)},
                         {"scores", json(calibration.scores)}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fsr
