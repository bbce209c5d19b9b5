#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "compensation/blend_table.h"
#include "compensation/training_statistics.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::compensation {

/// Errors of one taxel on curvatures that it was not trained on: each inner class in turn is predicted from
/// the others.
struct UnseenErrors {
  struct Bin {
    double readings = 0;
    double squares = 0;   ///< of the errors [Pa^2]
    double stated = 0;    ///< sum of the squared deviations that the class states itself [Pa^2]
    double pressure = 0;  ///< sum of the answers [Pa]
  };
  std::array<Bin, statistics::kPressureBins> bins;  ///< by predicted pressure
  /// Pressures of the readings, means of a code [Pa].
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  double readings() const;
  double rmse() const;  ///< [Pa]; NaN where there is no inner class
};

/// Adds the errors of the readings of one taxel. `answer` and `own` have one entry for each code: the
/// prediction, and the deviation that the taxel states itself.
void addErrors(const regression::CodeStatistics& readings, const std::vector<TableEntry>& answer,
               const std::vector<TableEntry>& own, UnseenErrors& errors);

/// Errors of all taxels together.
struct UnseenSummary {
  std::uint64_t readings = 0;
  statistics::Spread rmse_percent{};                       ///< over taxels, % of the range of pressure
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< of all readings [Pa]
};
UnseenSummary summaryOf(const std::vector<UnseenErrors>& taxels);

/// `law_without` [classes] is the law learned without each class; empty = no law. `tables` has one class or
/// more with a model at this taxel.
UnseenErrors leaveClassesOut(const CurvatureTables& tables, std::size_t taxel,
                             const TrainingStatistics& statistics, const std::vector<EffectLaw>& law_without);

/// The part of the errors of all taxels that the stated deviation does not explain. Empty if there is no
/// inner class.
UnseenDeviation unseenDeviation(const std::vector<UnseenErrors>& taxels);

}  // namespace fsr::compensation
