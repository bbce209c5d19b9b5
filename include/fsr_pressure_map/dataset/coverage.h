#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/sections.h"
#include "fsr_pressure_map/statistics/pressure_bins.h"

namespace fsr::dataset {

/// What the recordings hold of one pressure bin in one direction.
struct CoverageCell {
  std::uint64_t scans = 0;
  std::uint64_t cycles = 0;  ///< cycles that passed through
};

/// What the recordings hold of one curvature class.
struct ConditionCoverage {
  CurvatureClass condition;
  std::uint64_t scans = 0;
  std::uint64_t cycles = 0;
  double pressure_low = 0;   ///< gauge [Pa]
  double pressure_high = 0;  ///< gauge [Pa]
  std::array<CoverageCell, statistics::kPressureBins> loading;
  std::array<CoverageCell, statistics::kPressureBins> unloading;
};

/// Pressure x curvature x direction: where a calibration from these recordings stands on much data,
/// where on little, where on none.
struct Coverage {
  std::vector<ConditionCoverage> conditions;  ///< one for each curvature class
  std::vector<std::string> thin;              ///< sentences, worst first; empty = nothing is thin
};

/// A cell with fewer scans than this, or fewer cycles than there are sections, is called thin.
constexpr std::uint64_t kThinScans = 50;

/// What is thin among `conditions`, worst first; `sections` is their number.
std::vector<std::string> thinPlaces(const std::vector<ConditionCoverage>& conditions, std::size_t sections);

/// Adds what other recordings hold of the same class.
void addCoverage(const ConditionCoverage& more, ConditionCoverage& coverage);

/// `sections` has one entry for each recording.
Coverage measureCoverage(const std::vector<Recording>& recordings, const ConditionClasses& classes,
                         const std::vector<Sections>& sections);

/// The same with classes and sections as a calibration of the recordings has them.
Coverage coverageOf(const std::vector<Recording>& recordings, std::size_t sections);

}  // namespace fsr::dataset
