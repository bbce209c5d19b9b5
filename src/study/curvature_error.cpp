#include "study/hold_out.h"

#include <algorithm>
#include <cmath>

#include "compensation/fit_scheme.h"
#include "dataset/count_readers.h"
#include "matrix/for_each_taxel.h"
#include "study/unit_bootstrap.h"

namespace fsr::study {

namespace {

using compensation::TableEntry;

std::vector<TableEntry> entriesOf(const std::vector<double>& pressure) {
  std::vector<TableEntry> entries;
  for (const double value : pressure) entries.push_back({static_cast<float>(value), 0.0F});
  return entries;
}

// The readings of the classes that have any; `classes` are their indices.
regression::ClassReadings readingsOf(const std::vector<std::size_t>& classes,
                                     const regression::ClassReadings& training) {
  regression::ClassReadings some;
  some.full_scale = training.full_scale;
  for (const std::size_t c : classes) some.sums.push_back(training.sums[c]);
  return some;
}

std::vector<std::size_t> classesWithReadings(const regression::ClassReadings& training) {
  std::vector<std::size_t> classes;
  for (std::size_t c = 0; c < training.classes(); ++c)
    if (training.readings(c) > 0) classes.push_back(c);
  return classes;
}

// A held-out reading of one taxel. Blocks of them are read once for each error, which is several times faster
// than the scans themselves.
constexpr std::size_t kBlock = 4096;
struct HeldOutReading {
  double pressure;  // [Pa]
  std::uint32_t cycle;
  std::uint16_t code;
};

// Sums over readings at one error of the curvature [Pa^2].
struct ErrorSums {
  double squares = 0, moved = 0, stated = 0;

  // Squares are added to `by_cycle`, too.
  void add(const std::vector<HeldOutReading>& readings, const std::vector<TableEntry>& right,
           const std::vector<TableEntry>& told, std::vector<double>& by_cycle) {
    for (const HeldOutReading& reading : readings) {
      const TableEntry& entry = told[reading.code];
      const double error = entry.pressure - reading.pressure, deviation = entry.deviation;
      const double difference = entry.pressure - right[reading.code].pressure;
      by_cycle[reading.cycle] += error * error;
      squares += error * error;
      moved += difference * difference;
      stated += deviation * deviation;
    }
  }
};

// What one taxel contributes.
struct TaxelSums {
  std::vector<std::vector<double>> squares;  // of the errors [errors][cycles] [Pa^2]
  std::vector<double> percent;               // RMSE%, summed over folds [errors]
  std::vector<double> moved, stated;         // squares [errors] [Pa^2]

  TaxelSums(std::size_t errors, std::size_t cycles)
      : squares(errors, std::vector<double>(cycles, 0.0)),
        percent(errors, 0.0),
        moved(errors, 0.0),
        stated(errors, 0.0) {}
  void add(const TaxelSums& other);
};

void addTo(std::vector<double>& sums, const std::vector<double>& values) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
}

void TaxelSums::add(const TaxelSums& other) {
  for (std::size_t e = 0; e < squares.size(); ++e) addTo(squares[e], other.squares[e]);
  addTo(percent, other.percent);
  addTo(moved, other.moved);
  addTo(stated, other.stated);
}

// The scoring of one method.
class Scores {
 public:
  Scores(const StudyContext& study, const StudyMethod& method, const Validation& validation,
         const std::vector<FoldModel>& models)
      : study_(study),
        method_(method),
        validation_(validation),
        models_(models),
        errors_(curvatureErrors()),
        folds_(partsByFold(testParts(method, validation))),
        readings_(study.data.cycles, 0.0),
        class_of_cycle_(study.data.cycles, 0) {
    for (const FoldParts& part : folds_) range_.push_back(rangeOf(part));
  }

  CurvatureErrorCurve curve(const std::function<void()>& done) const;

 private:
  // Calls visit(scan) for each scan of a class that the fold holds out.
  template <typename Visit>
  void forEachHeldOut(const FoldParts& part, std::size_t c, Visit visit) const {
    for (const Cell& cell : validation_.folds[part.fold].test) {
      if (cell.curvature_class == c) validation_.grouping.scans[c][cell.group].forEach(visit);
    }
  }
  double rangeOf(const FoldParts& part);
  TaxelSums sumsOf(std::size_t taxel) const;
  void addClass(const AnswersAtCurvature& answers, std::size_t taxel, const FoldParts& part, std::size_t c,
                std::vector<double>& squares, TaxelSums& sums) const;
  CurvatureErrorScore score(std::size_t e, const TaxelSums& sums) const;

  const StudyContext& study_;
  const StudyMethod& method_;
  const Validation& validation_;
  const std::vector<FoldModel>& models_;
  const std::vector<CurvatureError> errors_;
  const std::vector<FoldParts> folds_;
  std::vector<double> range_;     // that RMSE% refers to, of each of folds_ [Pa]
  std::vector<double> readings_;  // of one taxel, by cycle
  std::vector<std::size_t> class_of_cycle_;
};

// Also counts the readings. NaN if the fold holds out no reading.
double Scores::rangeOf(const FoldParts& part) {
  double low = INFINITY, high = -INFINITY;
  for (const std::size_t c : part.classes) {
    forEachHeldOut(part, c, [&](const ScanPlace& scan) {
      const double pressure = study_.data.pressure(scan);
      low = std::min(low, pressure);
      high = std::max(high, pressure);
      const std::uint32_t cycle = study_.data.cycle(scan);
      readings_[cycle] += 1;
      class_of_cycle_[cycle] = c;
    });
  }
  return study_.plan.range == ScoreRange::kAll ? study_.data.highest - study_.data.lowest : high - low;
}

// Adds the readings of one class in one fold; to `squares` [errors], too.
void Scores::addClass(const AnswersAtCurvature& answers, std::size_t taxel, const FoldParts& part,
                      std::size_t c, std::vector<double>& squares, TaxelSums& sums) const {
  const double curvature = study_.data.classes[c].at(taxel);
  std::vector<TableEntry> right;
  answers.compute(curvature, 0, right);
  std::vector<std::vector<TableEntry>> wrong(errors_.size());  // empty = the right one
  for (std::size_t e = 0; e < errors_.size(); ++e) {
    const double told = errors_[e].told(curvature);
    const bool same = told == curvature || !compensation::usesCurvature(method_.plan.scheme);
    if (!same) answers.compute(told, std::abs(told - curvature), wrong[e]);
  }
  std::vector<ErrorSums> own(errors_.size());
  std::vector<HeldOutReading> readings;
  const auto addBlock = [&] {
    for (std::size_t e = 0; e < errors_.size(); ++e)
      own[e].add(readings, right, wrong[e].empty() ? right : wrong[e], sums.squares[e]);
    readings.clear();
  };
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*study_.data.recordings, taxel);
  forEachHeldOut(part, c, [&](const ScanPlace& scan) {
    readings.push_back(
        {study_.data.pressure(scan), study_.data.cycle(scan), counts[scan.recording][scan.number]});
    if (readings.size() == kBlock) addBlock();
  });
  addBlock();
  for (std::size_t e = 0; e < errors_.size(); ++e) {
    squares[e] += own[e].squares;
    sums.moved[e] += own[e].moved;
    sums.stated[e] += own[e].stated;
  }
}

TaxelSums Scores::sumsOf(std::size_t taxel) const {
  const TaxelReadings readings(study_.data, validation_.grouping, taxel);
  TaxelSums sums(errors_.size(), study_.data.cycles);
  for (std::size_t k = 0; k < folds_.size(); ++k) {
    const FoldParts& part = folds_[k];
    const AnswersAtCurvature answers(models_[part.fold], taxel,
                                     readings.training(validation_.folds[part.fold].train, false));
    std::vector<double> squares(errors_.size(), 0.0);
    double number = 0;
    for (const std::size_t c : part.classes) {
      addClass(answers, taxel, part, c, squares, sums);
      forEachHeldOut(part, c, [&](const ScanPlace&) { number += 1; });
    }
    for (std::size_t e = 0; e < errors_.size(); ++e)
      sums.percent[e] += 100.0 * std::sqrt(squares[e] / number) / range_[k];
  }
  return sums;
}

CurvatureErrorScore Scores::score(std::size_t e, const TaxelSums& sums) const {
  const StudyData& data = study_.data;
  const auto taxels = static_cast<double>(data.taxels.size());
  std::vector<double> readings, of_class(data.classes.size(), 0.0), number(data.classes.size(), 0.0);
  double all = 0;
  for (std::size_t cycle = 0; cycle < data.cycles; ++cycle) {
    readings.push_back(taxels * readings_[cycle]);
    all += readings.back();
    number[class_of_cycle_[cycle]] += readings.back();
    of_class[class_of_cycle_[cycle]] += sums.squares[e][cycle];
  }
  for (std::size_t c = 0; c < of_class.size(); ++c) of_class[c] = std::sqrt(of_class[c] / number[c]);
  CurvatureErrorScore score;
  score.error = errors_[e];
  score.rmse_percent = sums.percent[e] / (taxels * static_cast<double>(folds_.size()));
  score.rmse_interval = rmseInterval(sums.squares[e], readings, data, study_.plan);
  score.rmse = score.rmse_interval.estimate;
  score.rmse_of_class = of_class;
  score.moved = std::sqrt(sums.moved[e] / all);
  score.stated = std::sqrt(sums.stated[e] / all);
  return score;
}

CurvatureErrorCurve Scores::curve(const std::function<void()>& done) const {
  const std::vector<std::size_t>& taxels = study_.data.taxels;
  std::vector<TaxelSums> of_taxel(taxels.size(), TaxelSums(0, 0));
  matrix::forEachTaxel(taxels.size(), study_.plan.threads, [&](std::size_t t) {
    of_taxel[t] = sumsOf(taxels[t]);
    done();
  });
  // Taxels are added in their order, so that the result does not depend on the number of threads.
  TaxelSums sums(errors_.size(), study_.data.cycles);
  for (const TaxelSums& own : of_taxel) sums.add(own);
  CurvatureErrorCurve curve{method_.id, method_.label, {}};
  for (std::size_t e = 0; e < errors_.size(); ++e) curve.scores.push_back(score(e, sums));
  return curve;
}

}  // namespace

AnswersAtCurvature::AnswersAtCurvature(const FoldModel& model, std::size_t taxel,
                                       const regression::ClassReadings& training) {
  rule_.law = model.law;
  if (compensation::usesCurvature(model.plan.scheme))
    rule_.blend = compensation::blendOf(model.plan.scheme, model.regressor);
  tables_.codes = training.full_scale + 1u;
  if (rule_.blend == compensation::BlendRule::kKernel) {
    useKernels(model, taxel, training);
  } else {
    useTables(model, taxel, training);
  }
  for (const std::vector<TableEntry>& entries : entries_) tables_.table.push_back(entries.data());
  for (const std::vector<float>& weights : log_weight_) tables_.log_weight.push_back(weights.data());
}

void AnswersAtCurvature::useTables(const FoldModel& model, std::size_t taxel,
                                   const regression::ClassReadings& training) {
  const std::vector<regression::Fit> fits =
      compensation::fitScheme(model.plan, taxel, training, model.regressor);
  if (!compensation::usesCurvature(model.plan.scheme)) {
    tables_.curvature = {0.0};
    entries_ = {entriesOf(fits.front().pressure)};
    return;
  }
  for (const std::size_t c : classesWithReadings(training)) {
    tables_.curvature.push_back(model.plan.classes[c].at(taxel));
    entries_.push_back(entriesOf(fits[model.plan.model_of_class[c]].pressure));
  }
}

void AnswersAtCurvature::useKernels(const FoldModel& model, std::size_t taxel,
                                    const regression::ClassReadings& training) {
  const regression::SecondInput& input = *regression::entryOf(model.regressor).second_input;
  const double scale = compensation::inputsOf(model.plan, taxel, training, model.regressor).scale.front();
  length_scale_ = scale > 0 ? input.sigma(model.regressor) / scale : INFINITY;
  const std::vector<std::size_t> classes = classesWithReadings(training);
  for (const regression::KernelMean& mean : input.kernels(readingsOf(classes, training), model.regressor)) {
    tables_.curvature.push_back(model.plan.classes[classes[entries_.size()]].at(taxel));
    entries_.push_back(entriesOf(mean.pressure));
    log_weight_.emplace_back(mean.log_weight.begin(), mean.log_weight.end());
  }
}

void AnswersAtCurvature::compute(double at, double deviation, std::vector<TableEntry>& out) const {
  out.resize(tables_.codes);
  const compensation::CurvaturePlace place = compensation::placeOf(at, tables_.curvature);
  compensation::blendTable(rule_, length_scale_, tables_, at, place.share > 0.5 ? place.above : place.below,
                           out.data());
  // Only what the curvature adds is asked for.
  for (TableEntry& entry : out) entry.deviation = 0;
  if (deviation > 0) compensation::addCurvatureDeviation(tables_, at, deviation, out.data());
}

std::vector<CurvatureError> curvatureErrors() {
  std::vector<CurvatureError> errors;
  for (const double share : {-0.4, -0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2, 0.4}) errors.push_back({share, 0});
  for (const double step : {-2.0, -1.0, 1.0, 2.0}) errors.push_back({0, step});
  return errors;
}

CurvatureErrorCurve curvatureErrorsOf(const StudyContext& study, const StudyMethod& method,
                                      const Validation& validation, const std::vector<FoldModel>& models) {
  const std::string stage = "wrong curvatures, " + method.id;
  study.say(stage, 0, study.data.taxels.size());
  return Scores(study, method, validation, models).curve(study.counting(stage));
}

}  // namespace fsr::study
