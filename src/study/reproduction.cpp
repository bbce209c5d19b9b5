#include <algorithm>
#include <memory>

#include "statistics/random_stream.h"
#include "study/study_pieces.h"
#include "study/study_score.h"

namespace fsr::study {

namespace {

statistics::RepeatedMeasures measuresOf(const std::vector<const ScoredMethod*>& scored,
                                        std::vector<double> StudyScore::*measure) {
  statistics::RepeatedMeasures measures;
  for (const ScoredMethod* const one : scored) {
    measures.treatments.push_back(one->score.label);
    measures.values.push_back(one->score.*measure);
  }
  return measures;
}

ScoredMethod score(const StudyContext& study, const StudyMethod& method, const Split& split,
                   const regression::RegressorOptions& regressor, const std::string& stage) {
  const Grouping kept = downSampled(split.grouping, method.one_of, study.plan.down_sampling, study.plan.seed);
  const Evaluation evaluation = study.evaluateMethod(method, {kept, split.folds, Scoring::kByModel},
                                                     {plainModel(method, regressor)}, stage);
  ScoredMethod scored{scoreOf(study.data, method, evaluation), CycleSums(study.data, evaluation)};
  scored.score.rmse_percent_interval = rmsePercentInterval(scored.sums, study.data, study.plan);
  scored.score.rmse_interval = rmseInterval(scored.sums, study.data, study.plan);
  return scored;
}

// An algorithm on the paper's baseline.
ScoredMethod scoreAlgorithm(const StudyContext& study, const Split& split, const std::string& id,
                            const std::string& label) {
  const auto baseline = std::find_if(study.methods.begin(), study.methods.end(),
                                     [](const StudyMethod& method) { return method.id == "baseline"; });
  regression::RegressorOptions regressor{id, study.plan.grnn, study.plan.forest};
  regressor.forest.seed = statistics::randomStream(study.plan.seed, "forest").bits(0);
  ScoredMethod scored = score(study, *baseline, split, regressor, label + " on the baseline");
  scored.score.id = scored.score.model = id;
  scored.score.label = label;
  return scored;
}

StudyComparison compare(const StudyParts& parts, const std::string& id, const std::string& title,
                        const std::vector<const ScoredMethod*>& scored) {
  const StudyPlan& plan = parts.frame.plan;
  StudyComparison comparison{id, title, {}, {}, {}, {}};
  for (const ScoredMethod* const one : scored) comparison.scores.push_back(one->score);
  comparison.r2 = statistics::paperRule(measuresOf(scored, &StudyScore::r2), plan.tests);
  comparison.rmse_percent = statistics::paperRule(measuresOf(scored, &StudyScore::rmse_percent), plan.tests);
  for (std::size_t i = 0; i < scored.size(); ++i) {
    for (std::size_t j = i + 1; j < scored.size(); ++j) {
      comparison.differences.push_back(
          {scored[i]->score.label, scored[j]->score.label,
           differenceInterval(scored[i]->sums, scored[j]->sums, parts.units, plan)});
    }
  }
  return comparison;
}

// The scores of a part in the order of `ids`, without those that there are not.
std::vector<const ScoredMethod*> pick(const StudyParts& parts, const std::string& part,
                                      const std::vector<std::string>& ids) {
  std::vector<const ScoredMethod*> picked;
  for (const std::string& id : ids) {
    for (const auto& [number, piece] : parts.computed) {
      if (piece.part != part) continue;
      for (const ScoredMethod& one : piece.compared)
        if (one.score.id == id) picked.push_back(&one);
    }
  }
  return picked;
}

constexpr char kAlgorithms[] = "algorithms";
constexpr char kMethods[] = "methods";

}  // namespace

std::vector<PlannedPiece> comparisonPieces(const StudyContext& study) {
  std::vector<PlannedPiece> pieces;
  const auto split = std::make_shared<const Split>(leaveSectionOut(study.data));
  const auto add = [&](const std::string& id, const std::string& label) {
    pieces.push_back({kAlgorithms, [&study, split, id, label](StudyPiece& result) {
                        result.compared.push_back(scoreAlgorithm(study, *split, id, label));
                      }});
  };
  add("linear", "Linear regression");
  add("grnn", "GRNN");
  add("forest", "Random forest");
  for (const StudyMethod& method : study.methods) {
    pieces.push_back({kMethods, [&study, split, &method](StudyPiece& result) {
                        result.compared.push_back(score(study, method, *split,
                                                        grnnOf(study.plan.grnn, study.plan.grnn.bandwidth),
                                                        method.label));
                      }});
  }
  return pieces;
}

std::vector<StudyComparison> comparisonsOf(const StudyParts& parts) {
  std::vector<StudyComparison> comparisons;
  comparisons.push_back(compare(parts, "algorithms", "Algorithms on the baseline (the paper's Fig. 6)",
                                pick(parts, kAlgorithms, {"linear", "grnn", "forest"})));
  comparisons.push_back(compare(parts, "flat_against_all",
                                "Flat against all curvatures (the paper's Table 2)",
                                pick(parts, kMethods, {"flat_only", "baseline"})));
  comparisons.push_back(
      compare(parts, "methods", "Methods (the paper's Table 3)",
              pick(parts, kMethods,
                   {"baseline", "per_curvature", "curvature_input", "flat_or_curved", "binary_input"})));
  const std::vector<const ScoredMethod*> inputs = pick(parts, kMethods, {"curvature_input", "one_hot"});
  if (inputs.size() == 2) {
    comparisons.push_back(compare(parts, "one_hot", "Method 2 with a one-hot input", inputs));
  }
  return comparisons;
}

std::vector<PlannedPiece> bandwidthPieces(const StudyContext& study) {
  std::vector<PlannedPiece> pieces;
  const auto split = std::make_shared<const Split>(leaveSectionOut(study.data));
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    const StudyMethod& method = study.methods[m];
    if (method.plan.scheme == compensation::Scheme::kOneHot) continue;
    pieces.push_back(
        {"bandwidths", [&study, split, &method, m](StudyPiece& result) {
           study.say("Grid of bandwidths", m, study.methods.size());
           const Grouping kept =
               downSampled(split->grouping, method.one_of, study.plan.down_sampling, study.plan.seed);
           result.bandwidths.push_back(
               {method.id, method.label,
                bandwidthScores(study.data, method, {kept, split->folds, Scoring::kByModel}, study.plan)});
           study.say("Grid of bandwidths", m + 1, study.methods.size());
         }});
  }
  return pieces;
}

}  // namespace fsr::study
