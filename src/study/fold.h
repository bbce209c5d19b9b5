#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "regression/class_readings.h"
#include "regression/code_statistics.h"
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

}  // namespace fsr::study
