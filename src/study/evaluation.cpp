#include "fsr_pressure_map/study/evaluation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fsr_pressure_map/compensation/fit_scheme.h"
#include "fsr_pressure_map/matrix/for_each_taxel.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr {

namespace {

using Classes = std::vector<std::size_t>;

bool contains(const Classes& classes, std::size_t c) {
  return std::find(classes.begin(), classes.end(), c) != classes.end();
}

// Classes of the method's models that the fold trains on.
Classes trainedClasses(const StudyMethod& method, const Grouping& grouping, const Fold& fold) {
  Classes trained;
  for (const Cell& cell : fold.train) {
    const bool used = method.modelOf(cell.curvature_class) < method.models() &&
                      !grouping.scans[cell.curvature_class][cell.group].empty();
    if (used && !contains(trained, cell.curvature_class)) trained.push_back(cell.curvature_class);
  }
  return trained;
}

std::size_t nearest(const StudyData& data, const Classes& trained, std::size_t c) {
  return *std::min_element(trained.begin(), trained.end(), [&](std::size_t a, std::size_t b) {
    const auto distance = [&](std::size_t d) {
      return std::abs(data.classes[d].at(0) - data.classes[c].at(0));
    };
    return distance(a) < distance(b);
  });
}

// Which model answers for class c, and what it is asked.
std::pair<std::size_t, std::size_t> answering(const StudyData& data, const StudyMethod& method,
                                              const Classes& trained, std::size_t c) {
  const std::size_t own = method.modelOf(c);
  if (own < method.models()) {
    const Classes& classes = method.trainedOn(own);
    const auto knows = [&](std::size_t other) { return contains(classes, other); };
    if (std::any_of(trained.begin(), trained.end(), knows)) return {own, c};
  }
  const std::size_t stand_in = nearest(data, trained, c);
  return {method.modelOf(stand_in), stand_in};
}

std::vector<TestPart> partsOfFold(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                                  const Fold& fold, std::size_t number) {
  std::vector<TestPart> parts;
  const Classes trained = trainedClasses(method, grouping, fold);
  for (std::size_t m = 0; m < method.models(); ++m) parts.push_back({number, m, {}, {}});
  for (std::size_t c = 0; c < data.classes.size() && !trained.empty(); ++c) {
    const auto tests = [&](const Cell& cell) {
      return cell.curvature_class == c && !grouping.scans[c][cell.group].empty();
    };
    if (std::none_of(fold.test.begin(), fold.test.end(), tests)) continue;
    const auto [model, asked] = answering(data, method, trained, c);
    parts[model].tested.push_back(c);
    parts[model].asked.push_back(asked);
  }
  parts.erase(std::remove_if(parts.begin(), parts.end(), [](const TestPart& p) { return p.tested.empty(); }),
              parts.end());
  return parts;
}

// Visits (index of the class in part.tested, scan) of the held-out scans of a part.
template <typename Visit>
void forEachTested(const StudyData& data, const Grouping& grouping, const Fold& fold, const TestPart& part,
                   Visit visit) {
  for (std::size_t k = 0; k < part.tested.size(); ++k) {
    const std::size_t c = part.tested[k];
    for (const Cell& cell : fold.test) {
      if (cell.curvature_class != c) continue;
      for (const std::uint32_t i : grouping.scans[c][cell.group]) visit(k, data.scans[c][i]);
    }
  }
}

// Scores of one taxel, part by part.
class TaxelScoring {
 public:
  TaxelScoring(const StudyData& data, const StudyPlan& plan) : data_(data), plan_(plan) {}

  void begin() {
    predicted_.clear();
    reference_.clear();
  }
  void add(double predicted, double reference) {
    predicted_.push_back(predicted);
    reference_.push_back(reference);
    errors.push_back(static_cast<float>(predicted - reference));
  }
  void end() {
    r2_.push_back(rSquared(predicted_, reference_));
    const double percent = rmsePercent(predicted_, reference_);
    const auto [low, high] = std::minmax_element(reference_.begin(), reference_.end());
    const double own_range = *high - *low;
    const double range = plan_.range == ScoreRange::kAll ? data_.highest - data_.lowest : own_range;
    percent_.push_back(percent * own_range / range);
  }
  double r2() const { return spreadOf(r2_).mean; }
  double rmsePercentMean() const { return spreadOf(percent_).mean; }

  std::vector<float> errors;

 private:
  const StudyData& data_;
  const StudyPlan& plan_;
  std::vector<double> predicted_, reference_;  // of the part [Pa]
  std::vector<double> r2_, percent_;
};

}  // namespace

SplitRegressors kernels(const std::vector<double>& bandwidth, const GrnnOptions& options) {
  SplitRegressors regressors;
  for (const double value : bandwidth) {
    regressors.emplace_back();
    regressors.back().grnn = options;
    regressors.back().grnn.bandwidth = value;
  }
  return regressors;
}

std::vector<TestPart> testParts(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                                const std::vector<Fold>& folds) {
  std::vector<TestPart> parts;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    const auto of_fold = partsOfFold(data, method, grouping, folds[k], k);
    parts.insert(parts.end(), of_fold.begin(), of_fold.end());
  }
  return parts;
}

Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                    const std::vector<Fold>& folds, const SplitRegressors& regressors, const StudyPlan& plan,
                    const std::function<void()>& done) {
  Evaluation result;
  result.parts = testParts(data, method, grouping, folds);
  for (const TestPart& part : result.parts) {
    result.begin.push_back(result.scans.size());
    forEachTested(data, grouping, folds[part.fold], part,
                  [&](std::size_t, const StudyScan& scan) { result.scans.push_back(&scan); });
  }
  result.begin.push_back(result.scans.size());
  result.errors.resize(data.taxels.size());
  result.r2.resize(data.taxels.size());
  result.rmse_percent.resize(data.taxels.size());
  const bool by_samples = !makeRegressor(regressors.front())->mergeable();
  forEachTaxel(data.taxels.size(), plan.threads, [&](std::size_t t) {
    const std::size_t taxel = data.taxels[t];
    const TaxelReadings readings(data, grouping, taxel);
    TaxelScoring scoring(data, plan);
    scoring.errors.reserve(result.scans.size());
    std::vector<Fit> fits;
    for (std::size_t p = 0; p < result.parts.size(); ++p) {
      const TestPart& part = result.parts[p];
      if (p == 0 || part.fold != result.parts[p - 1].fold) {
        fits = fitScheme(method.plan, taxel, readings.training(folds[part.fold].train, by_samples),
                         regressors[regressors.size() == 1 ? 0 : part.fold]);
      }
      scoring.begin();
      forEachTested(data, grouping, folds[part.fold], part, [&](std::size_t k, const StudyScan& scan) {
        const std::vector<double>& table = fits[method.plan.model_of_class[part.asked[k]]].pressure;
        scoring.add(table[scan.counts[taxel]], fromFixed(scan.pressure));
      });
      scoring.end();
    }
    result.r2[t] = scoring.r2();
    result.rmse_percent[t] = scoring.rmsePercentMean();
    result.errors[t] = std::move(scoring.errors);
    if (done) done();
  });
  return result;
}

}  // namespace fsr
