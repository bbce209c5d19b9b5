#include "regression/regressors.h"
#include "report/calibration_report.h"
#include "report/members_json.h"

namespace fsr::report {

// The members of a calibration's report. They are found by their argument, so they are in no unnamed
// namespace.

static void members(MembersWriter& list, const calibration::Score& score) {
  list("readings", score.readings)("r2", score.r2)("rmse_percent", score.rmse_percent);
  list("worst_taxel", score.worst_taxel)("worst_rmse_percent", score.worst_rmse_percent);
  list("within_one_deviation", score.within_one_deviation)("errors_pa", score.errors);
}

static void members(MembersWriter& list, const calibration::ConditionScore& row) {
  list("surface", row.condition.surface)("curvature", row.condition.curvature)("trained", row.trained);
  members(list, row.score);
}

// UnseenScore or RemountScore.
template <typename LeftOut>
static void leftOutMembers(MembersWriter& list, const std::string& key, const LeftOut& score) {
  list.under(key, [&](MembersWriter& below) {
    below("readings", score.readings)("rmse", score.rmse)("rmse_percent_mean", score.rmse_percent.mean);
    below("rmse_percent_deviation", score.rmse_percent.deviation);
  });
}

static void members(MembersWriter& list, const calibration::CalibrationScores& scores) {
  list("conditions", scores.conditions)("whole", scores.whole);
  leftOutMembers(list, "unseen_curvature", scores.unseen);
  leftOutMembers(list, "another_mount", scores.remount);
}

static void members(MembersWriter& list, const dataset::CoverageCell& cell) {
  list("scans", cell.scans)("cycles", cell.cycles);
}

static void members(MembersWriter& list, const dataset::ConditionCoverage& row) {
  list("surface", row.condition.surface)("curvature", row.condition.curvature)("scans", row.scans);
  list("cycles", row.cycles).pair("pressure", row.pressure_low, row.pressure_high);
  binMembers(list, "loading", row.loading);
  binMembers(list, "unloading", row.unloading);
}

static void members(MembersWriter& list, const dataset::Coverage& coverage) {
  list("conditions", coverage.conditions)("thin", coverage.thin);
}

static void members(MembersWriter& list, const calibration::Correction& correction) {
  list("parent", correction.parent)("parent_date", correction.parent_date)("date", correction.date);
  list("by_taxel", correction.by_taxel)("gain", correction.gain)("offset_counts", correction.offset);
  list("surfaces", correction.surfaces)("bags", correction.bags)("cycles", correction.cycles);
  list("expected_rmse", correction.expected_rmse)("rmse_before", correction.rmse_before);
  list("rmse", correction.rmse);
}

static void members(MembersWriter& list, const calibration::TrainedRanges& trained) {
  const auto interval = [&](const char* key, const calibration::TrainedInterval& values) {
    list.pair(key, values.low, values.high);
  };
  interval("pressure", trained.pressure);
  interval("pressure_rate", trained.pressure_rate);
  interval("curvature", trained.curvature);
  interval("temperature", trained.temperature);
}

static void members(MembersWriter& list, const calibration::HistoryModel& model) {
  list("family", calibration::historyName(model.family))("radius", model.radius);
  list("play_weight", model.play_weight)("time_constant", model.time_constant);
  list("memory_weight", model.memory_weight)("knot", model.knot)("correction", model.correction);
  list("deviation_knot", model.deviation_knot)("loading_deviation", model.loading_deviation);
  list("unloading_deviation", model.unloading_deviation);
}

static void members(MembersWriter& list, const calibration::SessionScore::Session& session) {
  list("session", session.name)("count", session.readings)("static_rmse", session.rmse[0]);
  list("tared_rmse", session.rmse[1])("trained_and_tared_rmse", session.rmse[2]);
}

static void members(MembersWriter& list, const calibration::SessionZero& zero) {
  list("tare_expected", zero.expected());
  list("tables_trained_with_zeros", zero.tare == calibration::SessionTare::kTrained);
  list("rmse_without", zero.rmse_without)("rmse", zero.rmse);
}

static void members(MembersWriter& list, const calibration::TemperatureScore::Group& group) {
  list("left_out", group.name)("rmse_without", group.without)("rmse_with", group.with);
}

static void members(MembersWriter& list, const calibration::TemperatureModel& model) {
  list("sensitivity", model.sensitivity)("reference", model.reference)("lag", model.lag);
  list("low", model.low)("high", model.high)("spread", model.spread);
}

static void members(MembersWriter& list, const calibration::BudgetLine& line) {
  list("name", line.name)("source", calibration::budgetSourceName(line.source));
  list("part", calibration::budgetPartName(line.part))("standard_pa", line.standard)("added_pa", line.added);
  list("note", line.note);
}

static void members(MembersWriter& list, const calibration::BinScale& bin) {
  list("pressure_pa", bin.pressure)("factor", bin.factor)("within_tables", bin.within_tables);
  list("within_map", bin.within_map);
}

static void members(MembersWriter& list, const calibration::DeviationScale& scale) {
  binMembers(list, "bins", scale.bins);
  list("whole", scale.whole);
}

static void members(MembersWriter& list, const calibration::BinIntervals& bin) {
  list("units", bin.units)("factor_68", bin.factor[0])("covered_68", bin.covered[0]);
  list("factor_95", bin.factor[1])("covered_95", bin.covered[1]);
}

// Null where there is none.
template <typename T>
static Json resultIf(bool present, const T& value) {
  return present ? resultOf(value) : Json(nullptr);
}

static void members(MembersWriter& list, const calibration::ErrorIntervals& intervals) {
  list("unit", intervals.unit == calibration::IntervalUnit::kMounts ? "mounts" : "cycles");
  binMembers(list, "bins", intervals.bins);
  list("whole", intervals.whole);
  const auto covered = [&](const char* key, const auto& at_68, const auto& at_95) {
    list.under(key, [&](MembersWriter& below) { below("covered_68", at_68)("covered_95", at_95); });
  };
  const auto& by_direction = intervals.by_direction;
  covered("loading", by_direction[0][0], by_direction[1][0]);
  covered("unloading", by_direction[0][1], by_direction[1][1]);
  list("deviation_of_the_map", resultIf(intervals.scale.present(), intervals.scale));
  covered("taxels", intervals.by_taxel[0], intervals.by_taxel[1]);
}

static void members(MembersWriter& list, const calibration::ErrorBudget& budget) {
  list("share_of_range", calibration::kBudgetShares)("pressure_pa", budget.pressure)("lines", budget.lines);
  list("held_out_pa", budget.held_out)("combined_pa", budget.combined)("coverage_factor", 2);
  list("intervals", resultIf(budget.intervals.present(), budget.intervals));
}

// The options that the model uses.
static void modelMembers(MembersWriter& list, const calibration::Calibration& calibration) {
  const regression::RegressorOptions& options = calibration.regressor;
  list("name", options.name);
  if (options.name == "grnn") {
    list("bandwidth", options.grnn.bandwidth)("bandwidth_chosen", calibration.bandwidth_chosen);
    list("spread", regression::spreadName(options.grnn.spread));
    list("distance", regression::distanceName(options.grnn.distance));
    list("weighting", regression::weightingName(options.grnn.weighting));
  } else if (options.name == "forest") {
    list("trees", options.forest.trees)("minimum_leaf", options.forest.minimum_leaf);
    list("leaf_rule", regression::leafRuleName(options.forest.leaf_count));
  }
}

static void members(MembersWriter& list, const calibration::HistoryScore::Part& part) {
  list("readings", part.name)("count", part.readings)("static_rmse", part.static_rmse)("rmse", part.rmse);
  list("within_one_deviation", part.within_one_deviation);
}

// What training chose, by `score`, which has no sentence where it was not asked for: null.
template <typename Score, typename Model>
static Json chosen(const Score& score, const Model& model) {
  if (score.choice.empty()) return nullptr;
  MembersWriter list;
  list("choice", score.choice);
  members(list, model);
  if constexpr (std::is_same_v<Score, calibration::HistoryScore>) {
    list("protocols", score.protocols)("parts", score.parts);
  } else if constexpr (std::is_same_v<Score, calibration::SessionScore>) {
    list("sessions", score.sessions);
  } else {
    list("groups", score.groups);
  }
  return list.object;
}

static void members(MembersWriter& list, const calibration::Calibration& calibration) {
  const calibration::CalibrationScores& scores = calibration.scores;
  const compensation::Scheme scheme = calibration.tables.scheme;
  const matrix::Layout& layout = calibration.layout;
  list("id", calibration.id)("good_for", goodForText(calibration));
  list("scheme", compensation::schemeName(scheme));
  list.under("model", [&](MembersWriter& below) { modelMembers(below, calibration); });
  list("scheme_in_paper", compensation::schemeInPaper(scheme));
  list("length_scale", calibration.tables.rule.length_scale);
  list("model_of_class", calibration.tables.rule.model_of_class)("folds", calibration.folds);
  list("sensor", calibration.sensor).under("layout", [&](MembersWriter& below) {
    below("rows", layout.size.rows)("columns", layout.size.columns)("pitch_x", layout.pitch_x);
    below("pitch_y", layout.pitch_y)("full_scale", calibration.tables.full_scale);
  });
  list("trained", calibration.trained)("provenance", calibration.provenance);
  list("correction", resultIf(calibration.correction.present(), calibration.correction));
  list("warnings", calibration.warnings)("coverage", calibration.coverage);
  list("scores", resultIf(!scores.conditions.empty(), scores));
  list("history", chosen(scores.history, calibration.history));
  list("session", chosen(scores.session, calibration.session_zero));
  list("temperature", chosen(scores.temperature, calibration.temperature));
  list("error_budget", budgetJson(calibration.budget));
}

Json budgetJson(const calibration::ErrorBudget& budget) {
  return resultIf(budget.present(), budget);
}

std::string calibrationJson(const calibration::Calibration& calibration) {
  return dump(resultOf(calibration));
}

}  // namespace fsr::report
