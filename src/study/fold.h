#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "regression/code_statistics.h"
#include "regression/regressors.h"
#include "study/paper.h"
#include "study/study_data.h"

namespace fsr::study {

/// The scans of one class and group. They are held out, or used for training, together.
struct Cell {
  std::size_t curvature_class = 0;
  std::size_t group = 0;
};

/// One repetition of a cross-validation: training cells and test cells.
struct Fold {
  std::string name;
  std::vector<Cell> train;
  std::vector<Cell> test;
};

/// One way to hold data out.
struct Split {
  std::string id;           ///< five_sections, past_to_future, leave_protocol_out, leave_curvature_out, ...
  std::string description;  ///< a clause, e.g. "each mount is predicted by the other mounts of the matrix"
  Grouping grouping;        ///< of all scans
  std::vector<Fold> folds;
};

/// Fold k holds out section k of every class. This is the paper's cross-validation.
Split leaveSectionOut(const StudyData& data);
/// The first three fifths of the sections of each class predict the rest. One fold.
Split pastToFuture(const StudyData& data);
/// The id of leaveProtocolOut().
constexpr char kProtocolSplit[] = "leave_protocol_out";
/// Each protocol, i.e. the cycles of one pace, dwell and peak, is predicted by the other protocols. No folds
/// unless a class was recorded with two protocols. Fold k holds out one protocol: Fold::test has no other.
Split leaveProtocolOut(const StudyData& data);
/// The protocol that a fold of leaveProtocolOut() holds out.
std::size_t protocolOf(const Fold& fold);
/// Each class is predicted by the other classes. No folds if there are fewer than three classes.
Split leaveCurvatureOut(const StudyData& data);
/// Each mount is predicted by the other mounts. No folds unless each class was mounted more than once;
/// otherwise it would equal leaveCurvatureOut().
Split leaveMountOut(const StudyData& data);

/// The readings of one taxel, summed in cells.
class TaxelReadings {
 public:
  TaxelReadings(const StudyData& data, const Grouping& grouping, std::size_t taxel);

  const regression::CodeStatistics& cell(const Cell& cell) const {
    return cells_[cell.curvature_class * grouping_.groups + cell.group];
  }
  /// The readings of the given cells by class: as sums of each code, or as single readings if `by_samples`.
  regression::ClassReadings training(const std::vector<Cell>& cells, bool by_samples) const;

 private:
  const StudyData& data_;
  const Grouping& grouping_;
  std::size_t taxel_;
  std::vector<regression::CodeStatistics> cells_;
};

/// A method as trained in one fold: its regressor, and the parameters that its scheme has learned from the
/// training readings of the whole matrix.
struct FoldModel {
  compensation::SchemePlan plan;
  regression::RegressorOptions regressor;
  compensation::EffectLaw law;
};

regression::RegressorOptions grnnOf(const regression::GrnnOptions& options, double bandwidth);

/// A model without learned parameters, as in the paper.
FoldModel plainModel(const StudyMethod& method, const regression::RegressorOptions& regressor);

/// A model whose scheme has learned its length scale, curvature ranges or curvature law from the fold's
/// training cells, if the scheme has any. Length scale and ranges are learned on about plan.bandwidth_taxels
/// taxels, a law on all taxels.
FoldModel learnedModel(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                       const Fold& fold, double bandwidth, const StudyPlan& plan);

/// Pressure of every code for each of `classes` [classes][codes] [Pa], fitted to one taxel's training
/// readings.
std::vector<std::vector<double>> tablesFor(const FoldModel& model, std::size_t taxel,
                                           const regression::ClassReadings& training,
                                           const std::vector<std::size_t>& classes);

/// Every n-th of the studied taxels, about plan.bandwidth_taxels in all.
std::vector<std::size_t> taxelSample(const StudyData& data, const StudyPlan& plan);

}  // namespace fsr::study
