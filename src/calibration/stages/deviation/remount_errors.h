#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "calibration/stages/deviation/interval_tally.h"
#include "calibration/stages/deviation/new_mount_line.h"
#include "calibration/stages/tables/training_scans.h"
#include "compensation/fit_scheme.h"
#include "compensation/unseen_curvature.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "statistics/error_bins.h"

namespace fsr::calibration {

/// The errors on another mount: each mount of a surface that was mounted more than once is predicted by
/// models that were trained without it. A mount of a surface is identified by its number, in all recordings.
/// Recordings without a mount number (0) count as one mount, because nothing is known of them. A mount that
/// was loaded to less than half of the highest pressure on its surface, e.g. one at rest, is never left out
/// and never asked for: others cannot be predicted from it alone.
class RemountErrors {
 public:
  /// Recordings, sections and zeros must outlive the object.
  RemountErrors(const std::vector<dataset::Recording>& recordings, const dataset::ConditionClasses& classes,
                const std::vector<dataset::Sections>& sections, const SessionZeros& zeros);

  /// Whether a surface was mounted more than once.
  bool assessable() const { return most_mounts_ > 1; }
  /// Predicts the mounts of one taxel, whose tables are in `calibration`. Different taxels may be measured at
  /// the same time.
  void measure(const compensation::SchemePlan& plan, std::size_t taxel,
               const regression::RegressorOptions& regressor, const Calibration& calibration);
  /// Adds what the stated deviation does not explain to the deviation of all tables, by pressure. Returns the
  /// error of another mount.
  RemountScore apply(Calibration& calibration) const;
  /// Number of mounts that are left out, on all surfaces.
  std::size_t units() const;
  /// Counts the readings of each left-out mount by |error| / deviation, with the deviations of `calibration`
  /// after apply(). Trains as measure() does. Different taxels may be counted at the same time.
  void cover(const compensation::SchemePlan& plan, std::size_t taxel,
             const regression::RegressorOptions& regressor, const Calibration& calibration,
             IntervalTally& intervals);
  /// After cover() of all taxels.
  NewMountErrors newMount() const;

 private:
  // Whether the mounts of a class are left out: there are several, and its model was trained on the class.
  bool leavesOut(const compensation::SchemePlan& plan, std::size_t curvature_class) const;

  const std::vector<dataset::Sections>& divided_;
  std::vector<std::size_t> mounts_;              // [classes], number of mounts
  std::vector<std::vector<std::string>> names_;  // [classes][mounts]
  std::size_t most_mounts_ = 1;
  /// The section of a scan is its mount. Scans of a surface with one mount are in the last section, which is
  /// never left out.
  TrainingScans scans_;
  std::vector<compensation::UnseenErrors> errors_;  // [taxels]

  struct Squares {
    double sum = 0;  // of the errors [Pa^2]
    std::uint64_t readings = 0;
  };
  std::vector<std::vector<Squares>> covered_;  // [taxels][units]
  std::mutex adding_;
  statistics::ErrorSizes sizes_;  // of the errors of all units [Pa]
};

}  // namespace fsr::calibration
