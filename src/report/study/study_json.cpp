#include <fstream>
#include <string>
#include <type_traits>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/calibration_report.h"
#include "report/members_json.h"
#include "report/study/study_report.h"
#include "study/paper.h"
#include "study/study_pieces.h"

namespace fsr::report {

// The members of a study: of results.json, and of the file of a shard. See members_json.h.

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

namespace {

using settings::InputError;

template <typename T>
Json exactly(const T& value) {
  return MembersWriter(true).json(value);
}

// What is the same on all computers: all but the pieces and the date.
Json commonOf(const study::StudyParts& parts) {
  study::StudyParts common{parts.frame, parts.units, parts.pieces_of_study, {}};
  common.frame.provenance.date.clear();
  return exactly(common);
}

void flatten(const std::string& name, const Json& value, std::map<std::string, std::string>& options) {
  if (!value.is_object()) {
    options[name] = value.is_string() ? value.get<std::string>() : value.dump();
    return;
  }
  for (const auto& [key, below] : value.items()) flatten(name + "." + key, below, options);
}

}  // namespace

std::string studyPartsJson(const study::StudyParts& parts) {
  Json all = exactly(parts);
  all["computed"] = Json::array();
  for (const auto& [number, piece] : parts.computed)
    all["computed"].push_back({{"piece", number}, {"result", exactly(piece)}});
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

study::StudyParts readStudyParts(const std::string& path) {
  study::StudyParts parts;
  try {
    const Json all = Json::parse(std::ifstream(path));
    MembersReader::read(all, parts);
    for (const Json& one : all.at("computed"))
      MembersReader::read(one.at("result"), parts.computed[one.at("piece").get<std::size_t>()]);
  } catch (const std::exception&) {
    throw InputError(path + ": cannot be read as the pieces of a study; run this shard again");
  }
  return parts;
}

void addStudyParts(study::StudyParts other, const std::string& name, const std::string& first,
                   study::StudyParts& parts) {
  if (commonOf(other) != commonOf(parts))
    throw InputError(name + ": describes other recordings than " + first + "; run both shards again");
  for (auto& [number, piece] : other.computed) {
    if (!parts.computed.emplace(number, std::move(piece)).second)
      throw InputError(name + ": has piece " + std::to_string(number) +
                       " of the study, which is there already");
  }
}

std::map<std::string, std::string> studyOptions(const study::StudyPlan& plan) {
  std::map<std::string, std::string> options;
  flatten("plan", exactly(plan), options);
  // In the words of the plan's file.
  options["plan.down_sampling"] = study::downSamplingName(plan.down_sampling);
  options["plan.method_4"] =
      plan.binary_share == study::BinaryShare::kFullFlat ? "full_flat" : "half_and_half";
  options["plan.range"] = plan.range == study::ScoreRange::kHeldOut ? "held_out" : "all";
  options["plan.grnn.spread"] = plan.grnn.spread == regression::SpreadMeaning::kSigma ? "sigma" : "half";
  options["plan.grnn.distance"] =
      plan.grnn.distance == regression::KernelDistance::kSquared ? "squared" : "literal";
  options["plan.tests.normality_of"] =
      plan.tests.normality == statistics::NormalityOf::kEachTreatment ? "treatments" : "differences";
  if (plan.figure_taxel == study::StudyPlan{}.figure_taxel) options["plan.figure_taxel"] = "not given";
  return options;
}

}  // namespace fsr::report
