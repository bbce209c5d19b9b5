#pragma once

#include <array>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Errors on mounts that training left out in turn, of the static answer after the session's zero.
struct NewMountErrors {
  struct Mount {
    std::string name;  ///< e.g. "5_bent.bag, cylinder_6cm, mount 5"
    double rmse = 0;   ///< [Pa]
  };
  /// By kIntervalLevels: |error| that this share of all readings does not exceed [Pa].
  std::array<double, kIntervalLevels.size()> within = {};
  std::vector<Mount> mounts;  ///< empty = no surface was mounted more than once
};

/// The line of an error budget whose note is one sentence: what the map is good for on a new mount of a known
/// surface, the worst mount by name, and what to do next. `calibration`: complete but for its budget.
BudgetLine newMountLine(const Calibration& calibration, const NewMountErrors& errors);

/// The note of that line; empty where scores were not computed, and in files of earlier versions.
std::string newMountNote(const ErrorBudget& budget);

/// "6.1 kPa (1.0 % of the range)". `range`: of the trained pressures.
std::string errorText(double error, const TrainedInterval& range);

}  // namespace fsr::calibration
