#include "study/hold_out.h"

#include <cmath>
#include <limits>
#include <memory>

#include "matrix/for_each_taxel.h"

namespace fsr::study {

namespace {

using calibration::HistoryStream;
using calibration::HistorySums;
using calibration::LeftOutSums;
using calibration::StaticAnswer;

// Sets the codes of training; returns whether there are any.
bool setTrainedCodes(const regression::CodeHistogram& readings, StaticAnswer& answer) {
  const auto& count = readings.count();
  const auto occurs = [](std::int64_t number) { return number > 0; };
  const auto first = std::find_if(count.begin(), count.end(), occurs);
  if (first == count.end()) return false;
  const auto last = std::find_if(count.rbegin(), count.rend(), occurs);
  answer.lowest = static_cast<std::uint16_t>(first - count.begin());
  answer.highest = static_cast<std::uint16_t>(count.rend() - last - 1);
  return true;
}

}  // namespace

HistoryStudy::HistoryStudy(const StudyData& data, const Split& split, const std::vector<FoldModel>& models,
                           const StudyPlan& plan)
    : data_(data),
      split_(split),
      models_(models),
      plan_(plan),
      grid_(calibration::historyGrid(data.protocols.lowest, data.protocols.highest,
                                     data.protocols.longest_hold)),
      streams_(
          calibration::historyStreams(*data.recordings, data.class_of, data.divided, data.protocols, grid_)) {
  std::vector<std::vector<LeftOutSums>> each(data.taxels.size());
  matrix::forEachTaxel(each.size(), plan.threads, [&](std::size_t t) { each[t] = sumsOf(data.taxels[t]); });
  // Taxels are added in their order, so that the result does not depend on the number of threads.
  std::vector<std::string> names;
  std::vector<LeftOutSums> all;
  for (std::size_t k = 0; k < split.folds.size(); ++k) {
    names.push_back(split.folds[k].name);
    all.emplace_back(grid_.features());
    for (const std::vector<LeftOutSums>& own : each) all.back().merge(own[k]);
    all.back().finish();
  }
  verdict_ = calibration::chooseHistory({}, grid_, names, all);
}

std::vector<StaticAnswer> HistoryStudy::staticAnswers(std::size_t taxel, std::size_t fold,
                                                      const TaxelReadings& readings) const {
  const regression::ClassReadings training = readings.training(split_.folds[fold].train, false);
  std::vector<StaticAnswer> answers(data_.classes.size());
  std::vector<std::size_t> trained;
  for (std::size_t c = 0; c < answers.size(); ++c)
    if (setTrainedCodes(training.sums[c], answers[c])) trained.push_back(c);
  auto tables = tablesFor(models_[fold], taxel, training, trained);
  for (std::size_t i = 0; i < trained.size(); ++i) answers[trained[i]].pressure = std::move(tables[i]);
  calibration::setTrainedPressures(streams_, protocolOf(split_.folds[fold]), answers);
  return answers;
}

std::vector<LeftOutSums> HistoryStudy::sumsOf(std::size_t taxel) const {
  const TaxelReadings readings(data_, split_.grouping, taxel);
  std::vector<LeftOutSums> of_fold;
  for (std::size_t k = 0; k < split_.folds.size(); ++k) {
    const std::vector<StaticAnswer> answers = staticAnswers(taxel, k, readings);
    LeftOutSums sums(grid_.features());
    calibration::HistoryCourse course;
    for (const HistoryStream& stream : streams_)
      calibration::addHistoryRows(stream, grid_, taxel, answers, protocolOf(split_.folds[k]), course, sums);
    sums.finish();
    of_fold.push_back(std::move(sums));
  }
  return of_fold;
}

HeldOutAnswer HistoryStudy::answer(std::size_t taxel, std::size_t fold, const TaxelReadings& readings) const {
  const std::vector<StaticAnswer> tables = staticAnswers(taxel, fold, readings);
  const Eigen::VectorXd& coefficients = verdict_.coefficients[fold];
  Eigen::VectorXd features(Eigen::Index(grid_.features()));
  // Of the scans of each recording [Pa]; NaN = the static answer stands.
  const auto corrected = std::make_shared<std::vector<std::vector<double>>>(streams_.size());
  calibration::HistoryCourse course;
  for (const HistoryStream& stream : streams_) {
    std::vector<double>& own = (*corrected)[stream.number()];
    own.assign(stream.recording().scans(), std::numeric_limits<double>::quiet_NaN());
    stream.run(taxel, tables, course,
               [&](const HistoryStream::Scan& scan, double x, const double* state, const double* /*open*/) {
                 if (scan.protocol != protocolOf(split_.folds[fold])) return;
                 calibration::historyFeatures(grid_, x, state, features.data());
                 own[scan.number] = x + coefficients.dot(features);
               });
  }
  return [tables, corrected](std::size_t c, const ScanPlace& scan, std::uint16_t code) {
    const double pressure = (*corrected)[scan.recording][scan.number];
    return std::isnan(pressure) ? tables[c].pressure[code] : pressure;
  };
}

Evaluation HistoryStudy::evaluate(const StudyMethod& method, const std::function<void()>& done) const {
  const auto answers = [&](std::size_t t, const TaxelReadings& readings, const FoldParts& fold) {
    return answer(data_.taxels[t], fold.fold, readings);
  };
  return study::evaluate(data_, method, {split_.grouping, split_.folds, Scoring::kPooled},
                         HeldOutAnswers(answers), plan_, done);
}

}  // namespace fsr::study
