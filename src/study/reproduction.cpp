#include <algorithm>
#include <cmath>
#include <set>

#include "compensation/learn_scheme.h"
#include "matrix/for_each_taxel.h"
#include "statistics/random_stream.h"
#include "study/evaluation.h"
#include "study/study_context.h"
#include "study/unit_bootstrap.h"

namespace fsr::study {

namespace {

// A method's score, with its squared errors by cycle for the intervals of differences between methods.
struct ScoredMethod {
  StudyScore score;
  CycleSums sums;
};

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

StudyComparison compare(const StudyContext& study, const std::string& id, const std::string& title,
                        const std::vector<const ScoredMethod*>& scored) {
  const StudyPlan& plan = study.plan;
  StudyComparison comparison{id, title, {}, {}, {}, {}};
  for (const ScoredMethod* const one : scored) comparison.scores.push_back(one->score);
  comparison.r2 = statistics::paperRule(measuresOf(scored, &StudyScore::r2), plan.tests);
  comparison.rmse_percent = statistics::paperRule(measuresOf(scored, &StudyScore::rmse_percent), plan.tests);
  for (std::size_t i = 0; i < scored.size(); ++i) {
    for (std::size_t j = i + 1; j < scored.size(); ++j) {
      comparison.differences.push_back(
          {scored[i]->score.label, scored[j]->score.label,
           differenceInterval(scored[i]->sums, scored[j]->sums, study.data, plan)});
    }
  }
  return comparison;
}

// The scores in the order of `ids`, without those that there are not.
std::vector<const ScoredMethod*> pick(const std::vector<ScoredMethod>& scored,
                                      const std::vector<std::string>& ids) {
  std::vector<const ScoredMethod*> picked;
  for (const std::string& id : ids) {
    for (const ScoredMethod& one : scored)
      if (one.score.id == id) picked.push_back(&one);
  }
  return picked;
}

}  // namespace

std::vector<StudyComparison> comparisonsOf(const StudyContext& study) {
  const Split split = leaveSectionOut(study.data);
  const std::vector<ScoredMethod> algorithms = {scoreAlgorithm(study, split, "linear", "Linear regression"),
                                                scoreAlgorithm(study, split, "grnn", "GRNN"),
                                                scoreAlgorithm(study, split, "forest", "Random forest")};
  std::vector<ScoredMethod> methods;
  for (const StudyMethod& method : study.methods) {
    methods.push_back(
        score(study, method, split, grnnOf(study.plan.grnn, study.plan.grnn.bandwidth), method.label));
  }
  std::vector<StudyComparison> comparisons;
  comparisons.push_back(compare(study, "algorithms", "Algorithms on the baseline (the paper's Fig. 6)",
                                pick(algorithms, {"linear", "grnn", "forest"})));
  comparisons.push_back(compare(study, "flat_against_all",
                                "Flat against all curvatures (the paper's Table 2)",
                                pick(methods, {"flat_only", "baseline"})));
  comparisons.push_back(compare(
      study, "methods", "Methods (the paper's Table 3)",
      pick(methods, {"baseline", "per_curvature", "curvature_input", "flat_or_curved", "binary_input"})));
  const std::vector<const ScoredMethod*> inputs = pick(methods, {"curvature_input", "one_hot"});
  if (inputs.size() == 2) {
    comparisons.push_back(compare(study, "one_hot", "Method 2 with a one-hot input", inputs));
  }
  return comparisons;
}

std::vector<BandwidthCurve> bandwidthCurves(const StudyContext& study) {
  std::vector<BandwidthCurve> curves;
  const Split split = leaveSectionOut(study.data);
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    const StudyMethod& method = study.methods[m];
    if (method.plan.scheme == compensation::Scheme::kOneHot) continue;
    study.say("Grid of bandwidths", m, study.methods.size());
    const Grouping kept =
        downSampled(split.grouping, method.one_of, study.plan.down_sampling, study.plan.seed);
    curves.push_back(
        {method.id, method.label,
         bandwidthScores(study.data, method, {kept, split.folds, Scoring::kByModel}, study.plan)});
    study.say("Grid of bandwidths", m + 1, study.methods.size());
  }
  return curves;
}

namespace {

std::vector<regression::TestedCodes> testedClasses(const TestPart& part, const Fold& fold,
                                                   const TaxelReadings& readings) {
  std::vector<regression::TestedCodes> tested(part.tested.size());
  for (const Cell& cell : fold.test) {
    const auto place = std::find(part.tested.begin(), part.tested.end(), cell.curvature_class);
    if (place == part.tested.end()) continue;
    tested[static_cast<std::size_t>(place - part.tested.begin())].add(readings.cell(cell));
  }
  return tested;
}

// Range of pressure of a part's readings [Pa]. It is the same for all taxels.
double rangeOf(const StudyData& data, const Grouping& grouping, const Fold& fold, const TestPart& part,
               ScoreRange rule) {
  if (rule == ScoreRange::kAll) return data.highest - data.lowest;
  double low = INFINITY, high = -INFINITY;
  for (const Cell& cell : fold.test) {
    if (std::find(part.tested.begin(), part.tested.end(), cell.curvature_class) == part.tested.end())
      continue;
    grouping.scans[cell.curvature_class][cell.group].forEach([&](const ScanPlace& scan) {
      low = std::min(low, data.pressure(scan));
      high = std::max(high, data.pressure(scan));
    });
  }
  return high - low;
}

// 100 times the RMSE of a part [Pa]. `table` points to the tables of the part's classes.
double percentOf(const std::vector<regression::TestedCodes>& tested,
                 std::vector<std::vector<double>>::const_iterator table) {
  double squares = 0, number = 0;
  for (std::size_t k = 0; k < tested.size(); ++k) {
    squares += tested[k].squares(*table++);
    number += tested[k].readings();
  }
  return 100.0 * std::sqrt(squares / number);
}

}  // namespace

std::vector<double> bandwidthScores(const StudyData& data, const StudyMethod& method,
                                    const Validation& validation, const StudyPlan& plan) {
  const std::vector<Fold>& folds = validation.folds;
  const std::vector<TestPart> parts = testParts(method, validation);
  std::vector<double> range;
  for (const TestPart& part : parts) {
    range.push_back(rangeOf(data, validation.grouping, folds[part.fold], part, plan.range));
  }
  std::vector<std::vector<double>> of_taxel(data.taxels.size());
  matrix::forEachTaxel(data.taxels.size(), plan.threads, [&](std::size_t t) {
    const TaxelReadings readings(data, validation.grouping, data.taxels[t]);
    std::vector<double> sums(plan.bandwidths.size(), 0.0);
    for (const FoldParts& of_fold : partsByFold(parts)) {
      const regression::ClassReadings training = readings.training(folds[of_fold.fold].train, false);
      std::vector<std::vector<regression::TestedCodes>> tested;
      for (std::size_t p = of_fold.first; p < of_fold.end; ++p) {
        tested.push_back(testedClasses(parts[p], folds[of_fold.fold], readings));
      }
      for (std::size_t b = 0; b < sums.size(); ++b) {
        const FoldModel model = plainModel(method, grnnOf(plan.grnn, plan.bandwidths[b]));
        const auto tables = tablesFor(model, data.taxels[t], training, of_fold.classes);
        auto table = tables.begin();  // in the order of parts and their classes
        for (std::size_t p = of_fold.first; p < of_fold.end; ++p) {
          sums[b] += percentOf(tested[p - of_fold.first], table) / range[p];
          table += static_cast<std::ptrdiff_t>(parts[p].tested.size());
        }
      }
    }
    of_taxel[t] = sums;
  });
  std::vector<double> scores(plan.bandwidths.size(), 0.0);
  for (const auto& sums : of_taxel) {
    for (std::size_t b = 0; b < scores.size(); ++b) {
      scores[b] += sums[b] / static_cast<double>(parts.size() * of_taxel.size());
    }
  }
  return scores;
}

namespace {

// Divides a fold's training cells again: every second group is held out, then the others.
std::vector<Fold> innerFolds(const Fold& fold) {
  std::set<std::size_t> groups;
  for (const Cell& cell : fold.train) groups.insert(cell.group);
  std::vector<Fold> folds(2);
  for (const Cell& cell : fold.train) {
    const auto place = static_cast<std::size_t>(std::distance(groups.begin(), groups.find(cell.group)));
    folds[place % 2].test.push_back(cell);
    folds[1 - place % 2].train.push_back(cell);
  }
  return folds;
}

// Sum of squared errors of each bandwidth on one taxel [Pa^2].
std::vector<double> squaresOf(const StudyMethod& method, const std::vector<Fold>& inner,
                              const std::vector<TestPart>& parts, const TaxelReadings& readings,
                              std::size_t taxel, const StudyPlan& plan) {
  std::vector<double> squares(plan.bandwidths.size(), 0.0);
  for (const TestPart& part : parts) {
    const Fold& fold = inner[part.fold];
    const regression::ClassReadings training = readings.training(fold.train, false);
    for (std::size_t b = 0; b < squares.size(); ++b) {
      const FoldModel model = plainModel(method, grnnOf(plan.grnn, plan.bandwidths[b]));
      const auto tables = tablesFor(model, taxel, training, part.tested);
      for (const Cell& cell : fold.test) {
        const auto place = std::find(part.tested.begin(), part.tested.end(), cell.curvature_class);
        const auto k = static_cast<std::size_t>(place - part.tested.begin());
        squares[b] += compensation::squaredErrors(readings.cell(cell), tables[k]);
      }
    }
  }
  return squares;
}

}  // namespace

std::vector<double> chooseBandwidths(const StudyData& data, const StudyMethod& method,
                                     const Validation& validation, const StudyPlan& plan) {
  const std::vector<std::size_t> taxels = taxelSample(data, plan);
  std::vector<double> chosen;
  for (const Fold& fold : validation.folds) {
    const std::vector<Fold> inner = innerFolds(fold);
    const std::vector<TestPart> parts = testParts(method, {validation.grouping, inner, Scoring::kPooled});
    std::vector<std::vector<double>> of_taxel(taxels.size());
    matrix::forEachTaxel(taxels.size(), plan.threads, [&](std::size_t t) {
      const TaxelReadings readings(data, validation.grouping, taxels[t]);
      of_taxel[t] = squaresOf(method, inner, parts, readings, taxels[t], plan);
    });
    std::vector<double> sums(plan.bandwidths.size(), 0.0);
    for (const auto& squares : of_taxel) {
      for (std::size_t b = 0; b < sums.size(); ++b) sums[b] += squares[b];
    }
    const auto least = static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
    chosen.push_back(parts.empty() ? plan.grnn.bandwidth : plan.bandwidths[least]);
  }
  return chosen;
}

}  // namespace fsr::study
