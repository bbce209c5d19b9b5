#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "regression/class_readings.h"
#include "regression/code_statistics.h"
#include "study/study_data.h"

namespace fsr::study {

/// The scans of one class that are held out, or trained on, together.
struct Cell {
  std::size_t curvature_class = 0;
  std::size_t group = 0;
};

/// What one repetition of a validation trains on, and what it is scored on.
struct Fold {
  std::string name;
  std::vector<Cell> train;
  std::vector<Cell> test;
};

/// One way to hold data out.
struct Split {
  std::string id;           ///< five_sections, past_to_future, leave_curvature_out, leave_mount_out, ...
  std::string description;  ///< a sentence
  Grouping grouping;        ///< of all scans
  std::vector<Fold> folds;
};

/// Section k of every class, for each k: the paper's.
Split leaveSectionOut(const StudyData& data);
/// The first three fifths of each class predict the rest.
Split pastToFuture(const StudyData& data);
/// Every class predicted by the others; no folds where there are fewer than three.
Split leaveCurvatureOut(const StudyData& data);
/// Every mount predicted by the other mounts; no folds unless each class was mounted more than once, since
/// else it is leaveCurvatureOut().
Split leaveMountOut(const StudyData& data);

/// The readings of one taxel.
class TaxelReadings {
 public:
  TaxelReadings(const StudyData& data, const Grouping& grouping, std::size_t taxel);

  const regression::CodeStatistics& cell(const Cell& cell) const {
    return cells_[cell.curvature_class * grouping_.groups + cell.group];
  }
  /// What the cells hold together, by class; single readings too where `by_samples`.
  regression::ClassReadings training(const std::vector<Cell>& cells, bool by_samples) const;

 private:
  const StudyData& data_;
  const Grouping& grouping_;
  std::size_t taxel_;
  std::vector<regression::CodeStatistics> cells_;
};

}  // namespace fsr::study
