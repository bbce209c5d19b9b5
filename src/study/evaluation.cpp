#include "study/evaluation.h"

#include <algorithm>
#include <cmath>

#include "dataset/count_readers.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "matrix/for_each_taxel.h"
#include "statistics/reference_scatter.h"

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

// Calls visit(class, list) for the scans of each cell that a part holds out.
template <typename Visit>
void forEachTested(const Grouping& grouping, const Fold& fold, const TestPart& part, Visit visit) {
  for (const std::size_t c : part.tested) {
    for (const Cell& cell : fold.test) {
      if (cell.curvature_class == c) visit(c, grouping.scans[c][cell.group]);
    }
  }
}

// The reference pressures of a part, which are the same for all taxels.
statistics::ReferenceScatter referenceOf(const StudyData& data, const std::vector<const ScanList*>& scans) {
  statistics::ReferenceScatter reference;
  for (const ScanList* const list : scans)
    list->forEach([&](const ScanPlace& scan) { reference.add(data.pressure(scan)); });
  for (const ScanList* const list : scans)
    list->forEach([&](const ScanPlace& scan) { reference.addAgain(data.pressure(scan)); });
  return reference;
}

// Scores the answers for one taxel and writes its row of errors.
class TaxelScoring {
 public:
  TaxelScoring(const StudyData& data, const StudyPlan& plan, std::size_t t, std::vector<float>& errors)
      : data_(data),
        plan_(plan),
        counts_(dataset::taxelCounts(*data.recordings, data.taxels[t])),
        errors_(errors) {}

  void add(const HeldOutAnswer& answer, std::size_t c, const ScanList& scans) {
    scans.forEach([&](const ScanPlace& scan) {
      const double error = answer(c, scan, counts_[scan.recording][scan.number]) - data_.pressure(scan);
      squares_ += error * error;
      errors_.push_back(static_cast<float>(error));
    });
  }
  // Follows the readings of a part.
  void end(const statistics::ReferenceScatter& reference) {
    r2_.push_back(reference.rSquared(squares_));
    const double own_range = reference.range();
    const double range = plan_.range == ScoreRange::kAll ? data_.highest - data_.lowest : own_range;
    percent_.push_back(reference.rmsePercent(squares_) * own_range / range);
    squares_ = 0;
  }
  double r2() const { return statistics::spreadOf(r2_).mean; }
  double rmsePercentMean() const { return statistics::spreadOf(percent_).mean; }

 private:
  const StudyData& data_;
  const StudyPlan& plan_;
  std::vector<dataset::TaxelCounts> counts_;
  std::vector<float>& errors_;
  double squares_ = 0;  // of the part [Pa^2]
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
  std::vector<statistics::ReferenceScatter> references;
  std::size_t scored = 0;
  for (const TestPart& part : result.parts) {
    std::vector<const ScanList*>& scans = result.scans.emplace_back();
    forEachTested(grouping, folds[part.fold], part, [&](std::size_t, const ScanList& list) {
      scans.push_back(&list);
      scored += list.size();
    });
    references.push_back(referenceOf(data, scans));
  }
  result.errors.resize(data.taxels.size());
  result.r2.resize(data.taxels.size());
  result.rmse_percent.resize(data.taxels.size());
  matrix::forEachTaxel(data.taxels.size(), plan.threads, [&](std::size_t t) {
    const TaxelReadings readings(data, grouping, data.taxels[t]);
    result.errors[t].reserve(scored);
    TaxelScoring scoring(data, plan, t, result.errors[t]);
    for (const FoldParts& fold : partsByFold(result.parts)) {
      const HeldOutAnswer answer = answers(t, readings, fold);
      for (std::size_t p = fold.first; p < fold.end; ++p) {
        forEachTested(grouping, folds[fold.fold], result.parts[p],
                      [&](std::size_t c, const ScanList& list) { scoring.add(answer, c, list); });
        scoring.end(references[p]);
      }
    }
    result.r2[t] = scoring.r2();
    result.rmse_percent[t] = scoring.rmsePercentMean();
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
    return [&fold, tables = std::move(tables)](std::size_t c, const ScanPlace&, std::uint16_t code) {
      return tables[fold.placeOf(c)][code];
    };
  };
  return evaluate(data, method, validation, HeldOutAnswers(answers), plan, done);
}

}  // namespace fsr::study
