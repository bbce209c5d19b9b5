#include <algorithm>

#include "statistics/random_stream.h"
#include "study/study_context.h"
#include "study/study_score.h"

namespace fsr::study {

namespace {

// A method's score, with its squared errors by cycle for the bootstrap.
struct Scored {
  StudyScore score;
  CycleSums sums;
};

statistics::RepeatedMeasures measuresOf(const std::vector<const Scored*>& scored,
                                        std::vector<double> StudyScore::*measure) {
  statistics::RepeatedMeasures measures;
  for (const Scored* const one : scored) {
    measures.treatments.push_back(one->score.label);
    measures.values.push_back(one->score.*measure);
  }
  return measures;
}

Scored score(const StudyContext& study, const StudyMethod& method, const Split& split,
             const regression::RegressorOptions& regressor, const std::string& stage) {
  const Grouping kept = downSampled(split.grouping, method.one_of, study.plan.down_sampling, study.plan.seed);
  const Evaluation evaluation = study.evaluateMethod(method, {kept, split.folds, Scoring::kByModel},
                                                     {plainModel(method, regressor)}, stage);
  Scored scored{scoreOf(study.data, method, evaluation), CycleSums(study.data, evaluation)};
  scored.score.rmse_percent_interval = rmsePercentInterval(scored.sums, study.data, study.plan);
  scored.score.rmse_interval = rmseInterval(scored.sums, study.data, study.plan);
  return scored;
}

std::vector<Scored> algorithms(const StudyContext& study, const Split& split) {
  const auto baseline = std::find_if(study.methods.begin(), study.methods.end(),
                                     [](const StudyMethod& method) { return method.id == "baseline"; });
  std::vector<Scored> scored;
  const auto add = [&](const std::string& id, const std::string& label) {
    regression::RegressorOptions regressor{id, study.plan.grnn, study.plan.forest};
    regressor.forest.seed = statistics::randomStream(study.plan.seed, "forest").bits(0);
    scored.push_back(score(study, *baseline, split, regressor, label + " on the baseline"));
    scored.back().score.id = scored.back().score.model = id;
    scored.back().score.label = label;
  };
  add("linear", "Linear regression");
  add("grnn", "GRNN");
  add("forest", "Random forest");
  return scored;
}

StudyComparison compare(const StudyContext& study, const std::string& id, const std::string& title,
                        const std::vector<const Scored*>& scored) {
  StudyComparison comparison{id, title, {}, {}, {}, {}};
  for (const Scored* const one : scored) comparison.scores.push_back(one->score);
  comparison.r2 = statistics::paperRule(measuresOf(scored, &StudyScore::r2), study.plan.tests);
  comparison.rmse_percent =
      statistics::paperRule(measuresOf(scored, &StudyScore::rmse_percent), study.plan.tests);
  for (std::size_t i = 0; i < scored.size(); ++i) {
    for (std::size_t j = i + 1; j < scored.size(); ++j) {
      comparison.differences.push_back(
          {scored[i]->score.label, scored[j]->score.label,
           differenceInterval(scored[i]->sums, scored[j]->sums, study.data, study.plan)});
    }
  }
  return comparison;
}

}  // namespace

std::vector<StudyComparison> reproduce(const StudyContext& study) {
  std::vector<StudyComparison> comparisons;
  const Split split = leaveSectionOut(study.data);
  const std::vector<Scored> of_algorithms = algorithms(study, split);
  std::vector<Scored> scored;
  for (const StudyMethod& method : study.methods) {
    scored.push_back(
        score(study, method, split, grnnOf(study.plan.grnn, study.plan.grnn.bandwidth), method.label));
  }
  const auto pick = [&](const std::vector<std::string>& ids) {
    std::vector<const Scored*> picked;
    for (const std::string& id : ids) {
      for (const Scored& one : scored) {
        if (one.score.id == id) picked.push_back(&one);
      }
    }
    return picked;
  };
  comparisons.push_back(compare(study, "algorithms", "Algorithms on the baseline (the paper's Fig. 6)",
                                {&of_algorithms[0], &of_algorithms[1], &of_algorithms[2]}));
  comparisons.push_back(compare(study, "flat_against_all",
                                "Flat against all curvatures (the paper's Table 2)",
                                pick({"flat_only", "baseline"})));
  comparisons.push_back(
      compare(study, "methods", "Methods (the paper's Table 3)",
              pick({"baseline", "per_curvature", "curvature_input", "flat_or_curved", "binary_input"})));
  const std::vector<const Scored*> inputs = pick({"curvature_input", "one_hot"});
  if (inputs.size() == 2) {
    comparisons.push_back(compare(study, "one_hot", "Method 2 with a one-hot input", inputs));
  }
  return comparisons;
}

std::vector<BandwidthCurve> gridOfBandwidths(const StudyContext& study) {
  std::vector<BandwidthCurve> curves;
  const Split split = leaveSectionOut(study.data);
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    study.say("Grid of bandwidths", m, study.methods.size());
    const StudyMethod& method = study.methods[m];
    if (method.plan.scheme == compensation::Scheme::kOneHot) continue;
    const Grouping kept =
        downSampled(split.grouping, method.one_of, study.plan.down_sampling, study.plan.seed);
    curves.push_back(
        {method.id, method.label,
         bandwidthScores(study.data, method, {kept, split.folds, Scoring::kByModel}, study.plan)});
  }
  study.say("Grid of bandwidths", study.methods.size(), study.methods.size());
  return curves;
}

}  // namespace fsr::study
