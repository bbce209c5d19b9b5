#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::dataset {

/// Data of one pressure bin in one direction of load.
struct CoverageCell {
  std::uint64_t scans = 0;
  std::uint64_t cycles = 0;  ///< cycles that passed through the bin
};

/// Data of one curvature class.
struct ConditionCoverage {
  CurvatureClass condition;
  std::uint64_t scans = 0;
  std::uint64_t cycles = 0;
  double pressure_low = 0;   ///< gauge [Pa]
  double pressure_high = 0;  ///< gauge [Pa]
  std::array<CoverageCell, statistics::kPressureBins> loading;
  std::array<CoverageCell, statistics::kPressureBins> unloading;
};

/// Amount of data for each curvature class, pressure bin and direction of load.
struct Coverage {
  std::vector<ConditionCoverage> conditions;  ///< one for each curvature class
  std::vector<std::string>
      thin;  ///< sentences on bins with little or no data, worst first; empty = there are none
};

/// A cell with fewer scans than this, or with fewer cycles than there are sections, is called thin.
constexpr std::uint64_t kThinScans = 50;

/// Sentences on the thin cells of `conditions`, worst first. `sections`: number of sections of the
/// cross-validation.
std::vector<std::string> thinPlaces(const std::vector<ConditionCoverage>& conditions, std::size_t sections);

/// Adds the data that other recordings hold of the same class.
void addCoverage(const ConditionCoverage& more, ConditionCoverage& coverage);

/// Coverage of the classes and sections that a calibration of the recordings would use. `sections`: number of
/// sections of the cross-validation.
Coverage coverageOf(const std::vector<Recording>& recordings, std::size_t sections);

}  // namespace fsr::dataset
