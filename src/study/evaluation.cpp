#include "study/evaluation.h"

#include <algorithm>
#include <cmath>

#include "dataset/count_readers.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "matrix/for_each_taxel.h"
#include "statistics/error_bins.h"
#include "statistics/samples.h"
#include "study/unit_bootstrap.h"

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

namespace {

std::string howScored(const StudyMethod& method, const Evaluation& evaluation) {
  if (method.models() == 1) return "one model, its readings pooled";
  const std::string models = std::to_string(method.models()) + " models";
  return evaluation.models == 1 ? "the readings of " + models + " pooled" : "mean of the scores of " + models;
}

void summarise(const StudyData& data, const Evaluation& evaluation, StudyScore& score) {
  statistics::ErrorBins bins;
  statistics::ErrorTally first, later;
  for (std::size_t t = 0; t < data.taxels.size(); ++t) {
    evaluation.forEachError(t, [&](const TestPart&, const ScanPlace& scan, float error) {
      bins.add(error, data.pressure(scan), data.direction(scan));
      (data.inFirstCycle(scan) ? first : later).add(error);
    });
  }
  score.errors = bins.summarise();
  score.first_cycle = first.summarise();
  score.later_cycles = later.summarise();
}

}  // namespace

StudyScore scoreOf(const StudyData& data, const StudyMethod& method, const Evaluation& evaluation) {
  StudyScore score;
  score.id = method.id;
  score.label = method.label;
  score.model = "grnn";
  score.scored = howScored(method, evaluation);
  score.scans = evaluation.errors.front().size();
  score.r2 = evaluation.r2;
  score.rmse_percent = evaluation.rmse_percent;
  score.r2_spread = statistics::spreadOf(evaluation.r2);
  score.rmse_percent_spread = statistics::spreadOf(evaluation.rmse_percent);
  const auto worst = std::max_element(score.rmse_percent.begin(), score.rmse_percent.end());
  score.worst_rmse_percent = *worst;
  score.worst_taxel = data.taxels[static_cast<std::size_t>(worst - score.rmse_percent.begin())];
  summarise(data, evaluation, score);
  return score;
}

namespace {

// The bent class of smallest curvature, as in the paper's figures; the flat class if there is no bent one.
std::size_t gentlestBend(const StudyData& data) {
  std::size_t chosen = 0;
  double gentlest = INFINITY;
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    const double bend = std::abs(data.classes[c].at(0));
    if (dataset::isFlat(data.classes[c]) || bend >= gentlest) continue;
    gentlest = bend;
    chosen = c;
  }
  return chosen;
}

// A figure does not show more scans of a section. A longer section is shown by one scan of several.
constexpr std::size_t kMostScans = 20000;

// Which scans of a section of a class the figure shows: one of some.
class ShownScans {
 public:
  ShownScans(const StudyData& data, std::size_t c, std::uint32_t section) : data_(data), section_(section) {
    std::size_t scans = 0;
    data.scans[c].forEach([&](const ScanPlace& scan) { scans += data.section(scan) == section; });
    one_of_ = std::max<std::size_t>(1, (scans + kMostScans - 1) / kMostScans);
  }
  // Whether the next scan of the class is shown.
  bool operator()(const ScanPlace& scan) {
    return data_.section(scan) == section_ && number_++ % one_of_ == 0;
  }

 private:
  const StudyData& data_;
  std::uint32_t section_;
  std::size_t one_of_ = 1, number_ = 0;
};

TaxelResponse::Curve curveOf(const StudyData& data, std::size_t c, std::size_t taxel, std::uint32_t section) {
  TaxelResponse::Curve curve{data.classes[c].surface, data.classes[c].at(taxel), {}, {}, {}};
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data.recordings, taxel);
  ShownScans shown(data, c, section);
  data.scans[c].forEach([&](const ScanPlace& scan) {
    if (!shown(scan)) return;
    curve.time.push_back(data.time(scan));
    curve.pressure.push_back(data.pressure(scan));
    curve.counts.push_back(counts[scan.recording][scan.number]);
  });
  return curve;
}

// Held-out predictions for the scans of curveOf() [Pa].
std::vector<double> predictions(const StudyData& data, const Evaluation& evaluation, std::size_t c,
                                std::uint32_t section, std::size_t place) {
  std::vector<double> predicted;
  ShownScans shown(data, c, section);
  evaluation.forEachError(place, [&](const TestPart&, const ScanPlace& scan, float error) {
    if (data.classOf(scan) == c && shown(scan)) predicted.push_back(data.pressure(scan) + error);
  });
  return predicted;
}

}  // namespace

TaxelResponse taxelResponse(const StudyData& data, std::size_t place, const Evaluation& baseline,
                            const Evaluation& per_curvature) {
  const auto section = static_cast<std::uint32_t>(data.sections / 2);
  TaxelResponse response;
  response.taxel = data.taxels[place];
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    response.curves.push_back(curveOf(data, c, response.taxel, section));
  }
  const std::size_t bend = gentlestBend(data);
  const TaxelResponse::Curve& curve = response.curves[bend];
  response.prediction = {curve.surface,
                         curve.curvature,
                         curve.time,
                         curve.pressure,
                         predictions(data, baseline, bend, section, place),
                         predictions(data, per_curvature, bend, section, place)};
  return response;
}

std::size_t figureTaxel(const StudyData& data, const StudyPlan& plan,
                        const std::vector<double>& rmse_percent) {
  const auto asked = std::find(data.taxels.begin(), data.taxels.end(), plan.figure_taxel);
  if (asked != data.taxels.end()) return static_cast<std::size_t>(asked - data.taxels.begin());
  const double middle = statistics::upperMedian(rmse_percent);
  return static_cast<std::size_t>(std::find(rmse_percent.begin(), rmse_percent.end(), middle) -
                                  rmse_percent.begin());
}

}  // namespace fsr::study
