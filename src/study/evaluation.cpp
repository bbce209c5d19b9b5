#include "study/evaluation.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/statistics/metrics.h"
#include "matrix/for_each_taxel.h"

namespace fsr::study {

namespace {

bool holds(const Grouping& grouping, const std::vector<Cell>& cells, std::size_t c) {
  return std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) {
    return cell.curvature_class == c && !grouping.scans[c][cell.group].empty();
  });
}

// Whether the fold has training data for any of the method's models.
bool trains(const StudyMethod& method, const Grouping& grouping, const Fold& fold) {
  for (const compensation::SchemePlan::Model& model : method.plan.models) {
    for (const std::size_t c : model.trained_on) {
      if (holds(grouping, fold.train, c)) return true;
    }
  }
  return false;
}

std::vector<TestPart> partsOfFold(const StudyMethod& method, const Grouping& grouping, const Fold& fold,
                                  std::size_t number, Scoring scoring) {
  std::vector<TestPart> parts(scoring == Scoring::kPooled ? 1 : method.models());
  if (!trains(method, grouping, fold)) return {};
  for (std::size_t c = 0; c < grouping.scans.size(); ++c) {
    if (!holds(grouping, fold.test, c)) continue;
    parts[scoring == Scoring::kPooled ? 0 : method.modelOf(c)].tested.push_back(c);
  }
  for (std::size_t m = 0; m < parts.size(); ++m) {
    parts[m].fold = number;
    parts[m].model = m;
  }
  parts.erase(
      std::remove_if(parts.begin(), parts.end(), [](const TestPart& part) { return part.tested.empty(); }),
      parts.end());
  return parts;
}

// Calls visit(class, scan) for each held-out scan of a part.
template <typename Visit>
void forEachTested(const StudyData& data, const Grouping& grouping, const Fold& fold, const TestPart& part,
                   Visit visit) {
  for (const std::size_t c : part.tested) {
    for (const Cell& cell : fold.test) {
      if (cell.curvature_class != c) continue;
      for (const std::uint32_t i : grouping.scans[c][cell.group]) visit(c, data.scans[c][i]);
    }
  }
}

// Collects the scores of one taxel. Between begin() and end() come the readings of one part.
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
    r2_.push_back(statistics::rSquared(predicted_, reference_));
    const double percent = statistics::rmsePercent(predicted_, reference_);
    const auto [low, high] = std::minmax_element(reference_.begin(), reference_.end());
    const double own_range = *high - *low;
    const double range = plan_.range == ScoreRange::kAll ? data_.highest - data_.lowest : own_range;
    percent_.push_back(percent * own_range / range);
  }
  double r2() const { return statistics::spreadOf(r2_).mean; }
  double rmsePercentMean() const { return statistics::spreadOf(percent_).mean; }

  std::vector<float> errors;

 private:
  const StudyData& data_;
  const StudyPlan& plan_;
  std::vector<double> predicted_, reference_;  // of the part [Pa]
  std::vector<double> r2_, percent_;
};

}  // namespace

std::vector<TestPart> testParts(const StudyMethod& method, const Validation& validation) {
  std::vector<TestPart> parts;
  for (std::size_t k = 0; k < validation.folds.size(); ++k) {
    const auto of_fold = partsOfFold(method, validation.grouping, validation.folds[k], k, validation.scoring);
    parts.insert(parts.end(), of_fold.begin(), of_fold.end());
  }
  return parts;
}

std::vector<FoldParts> partsByFold(const std::vector<TestPart>& parts) {
  std::vector<FoldParts> folds;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (folds.empty() || folds.back().fold != parts[p].fold) folds.push_back({parts[p].fold, p, p, {}});
    FoldParts& fold = folds.back();
    fold.end = p + 1;
    fold.classes.insert(fold.classes.end(), parts[p].tested.begin(), parts[p].tested.end());
  }
  return folds;
}

std::size_t FoldParts::placeOf(std::size_t curvature_class) const {
  const auto place = std::find(classes.begin(), classes.end(), curvature_class);
  return static_cast<std::size_t>(place - classes.begin());
}

Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Validation& validation,
                    const HeldOutAnswers& answers, const StudyPlan& plan, const std::function<void()>& done) {
  const Grouping& grouping = validation.grouping;
  const std::vector<Fold>& folds = validation.folds;
  Evaluation result;
  result.parts = testParts(method, validation);
  result.models = validation.scoring == Scoring::kPooled ? 1 : method.models();
  for (const TestPart& part : result.parts) {
    result.begin.push_back(result.scans.size());
    forEachTested(data, grouping, folds[part.fold], part,
                  [&](std::size_t, const StudyScan& scan) { result.scans.push_back(&scan); });
  }
  result.begin.push_back(result.scans.size());
  result.errors.resize(data.taxels.size());
  result.r2.resize(data.taxels.size());
  result.rmse_percent.resize(data.taxels.size());
  matrix::forEachTaxel(data.taxels.size(), plan.threads, [&](std::size_t t) {
    const std::size_t taxel = data.taxels[t];
    const TaxelReadings readings(data, grouping, taxel);
    TaxelScoring scoring(data, plan);
    scoring.errors.reserve(result.scans.size());
    for (const FoldParts& fold : partsByFold(result.parts)) {
      const HeldOutAnswer answer = answers(t, readings, fold);
      for (std::size_t p = fold.first; p < fold.end; ++p) {
        scoring.begin();
        forEachTested(data, grouping, folds[fold.fold], result.parts[p],
                      [&](std::size_t c, const StudyScan& scan) {
                        scoring.add(answer(c, scan), regression::fromFixed(scan.pressure));
                      });
        scoring.end();
      }
    }
    result.r2[t] = scoring.r2();
    result.rmse_percent[t] = scoring.rmsePercentMean();
    result.errors[t] = std::move(scoring.errors);
    if (done) done();
  });
  return result;
}

Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Validation& validation,
                    const std::vector<FoldModel>& models, const StudyPlan& plan,
                    const std::function<void()>& done) {
  const bool by_samples = !regression::makeRegressor(models.front().regressor)->mergeable();
  const auto answers = [&](std::size_t t, const TaxelReadings& readings, const FoldParts& fold) {
    const std::size_t taxel = data.taxels[t];
    auto tables = tablesFor(models[models.size() == 1 ? 0 : fold.fold], taxel,
                            readings.training(validation.folds[fold.fold].train, by_samples), fold.classes);
    return [&fold, taxel, tables = std::move(tables)](std::size_t c, const StudyScan& scan) {
      return tables[fold.placeOf(c)][scan.counts[taxel]];
    };
  };
  return evaluate(data, method, validation, HeldOutAnswers(answers), plan, done);
}

}  // namespace fsr::study
