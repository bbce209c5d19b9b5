#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "calibration/stages/memory/history_training.h"
#include "compensation/blend_table.h"
#include "study/evaluation.h"
#include "study/fold.h"
#include "study/study_context.h"

namespace fsr::study {

/// The answers of one taxel at any curvature, as the live map gives them: blendTable() and
/// addCurvatureDeviation() on the tables of a fold's training readings.
class AnswersAtCurvature {
 public:
  /// `training` must have readings of at least one class.
  AnswersAtCurvature(const FoldModel& model, std::size_t taxel, const regression::ClassReadings& training);
  AnswersAtCurvature(const AnswersAtCurvature&) = delete;  // tables_ points into entries_ and log_weight_
  AnswersAtCurvature& operator=(const AnswersAtCurvature&) = delete;

  /// Pressure of each code at the curvature `at` [1/m], and what a standard deviation of the curvature
  /// `deviation` [1/m] adds to the deviation of the pressure.
  void compute(double at, double deviation, std::vector<compensation::TableEntry>& out) const;

 private:
  void useTables(const FoldModel& model, std::size_t taxel, const regression::ClassReadings& training);
  void useKernels(const FoldModel& model, std::size_t taxel, const regression::ClassReadings& training);

  compensation::CurvatureRule rule_;
  double length_scale_ = 0;                                     // [1/m]
  std::vector<std::vector<compensation::TableEntry>> entries_;  // [classes][codes]
  std::vector<std::vector<float>> log_weight_;                  // likewise; empty unless kernels are blended
  compensation::TaxelTables tables_;
};

/// The errors of curvature that the study tries: shares of the curvature, ascending, with 0 among them; then
/// steps in 1/m.
std::vector<CurvatureError> curvatureErrors();

/// Scores the method on the held-out readings of the validation once for each of curvatureErrors(). Tables
/// are trained with the true curvatures. `models`: the method in each fold.
CurvatureErrorCurve curvatureErrorsOf(const StudyContext& study, const StudyMethod& method,
                                      const Validation& validation, const std::vector<FoldModel>& models);

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

  /// Codes and pressures that training did not have have the static answer.
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
  calibration::HistoryGrid grid_;
  std::vector<calibration::HistoryStream> streams_;  // in the order of time
  calibration::HistoryVerdict verdict_;
};

}  // namespace fsr::study
