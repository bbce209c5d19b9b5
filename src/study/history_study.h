#pragma once

#include <functional>
#include <vector>

#include "calibration/history_training.h"
#include "study/evaluation.h"

namespace fsr::study {

/// A method with a model of the sheet's memory, in the folds of leaveProtocolOut(). Tables and weights are
/// trained without the protocol that is held out; the operators are driven by the whole course of time.
class HistoryStudy {
 public:
  /// Trains. `models`: the method in each fold. All arguments must outlive the object.
  HistoryStudy(const StudyData& data, const Split& split, const std::vector<FoldModel>& models,
               const StudyPlan& plan);

  /// The choice that `train --history auto` would make. Its score has no protocols if no reading counts: then
  /// there is nothing to evaluate.
  const calibration::HistoryVerdict& verdict() const { return verdict_; }

  /// Readings before the model is settled, and codes that training did not have, have the static answer.
  Evaluation evaluate(const StudyMethod& method, const std::function<void()>& done) const;

 private:
  std::vector<calibration::StaticAnswer> staticAnswers(std::size_t taxel, std::size_t fold,
                                                       const TaxelReadings& readings) const;
  std::vector<calibration::LeftOutSums> sumsOf(std::size_t taxel) const;
  HeldOutAnswer answer(std::size_t taxel, std::size_t fold, const TaxelReadings& readings) const;

  const StudyData& data_;
  const Split& split_;
  const std::vector<FoldModel>& models_;
  const StudyPlan& plan_;
  compensation::HistoryGrid grid_;
  std::vector<calibration::HistoryStream> streams_;  // [recordings]
  calibration::HistoryVerdict verdict_;
};

}  // namespace fsr::study
