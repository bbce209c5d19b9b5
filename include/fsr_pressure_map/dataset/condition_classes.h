#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::dataset {

/// A curvature class: conditions of any number of bags whose curvatures agree.
struct CurvatureClass {
  std::string surface;  ///< name of its condition, e.g. cylinder_7cm
  std::vector<double>
      curvature;  ///< principal curvature, one for all taxels or one for each, row-major [1/m]

  double at(std::size_t taxel) const {
    return curvature.size() == 1 ? curvature.front() : curvature.at(taxel);
  }
};

/// Largest |principal curvature| of a surface that counts as flat [1/m]. It is a radius of 4 m.
constexpr double kFlatCurvature = 0.25;
/// Conditions whose curvatures differ by no more than this at any taxel form one class [1/m].
constexpr double kSameClassCurvature = 0.25;

/// Whether the class is flat at every taxel.
bool isFlat(const CurvatureClass& curvature_class);

/// One condition of one recording.
struct RecordedCondition {
  CurvatureClass condition;
  std::uint64_t scans = 0;
};

/// The criterion by which conditions form a class.
enum class PooledBy {
  kCurvature,  ///< curvatures agree within kSameClassCurvature at every taxel
  kName,       ///< surfaces have the same name
};

/// Conditions, grouped into classes.
struct PooledConditions {
  std::vector<CurvatureClass> classes;  ///< by ascending curvature of taxel 0
  std::vector<std::size_t> class_of;    ///< of each condition, index into `classes`
};

/// Groups conditions into classes. Name and curvature of a class are those of its member with the most scans.
/// The classes do not depend on the order of the conditions.
PooledConditions poolConditions(const std::vector<RecordedCondition>& conditions,
                                PooledBy by = PooledBy::kCurvature);

/// The conditions of a recording, in the same order. Throws InputError where a curvature is unknown.
std::vector<RecordedCondition> conditionsOf(const Recording& recording);

/// The conditions of several recordings, grouped into classes.
struct ConditionClasses {
  /// By ascending curvature of taxel 0.
  std::vector<CurvatureClass> classes;
  /// [recordings][conditions of that recording] -> index into `classes`.
  std::vector<std::vector<std::size_t>> class_of;
};

/// Groups the conditions of several recordings. With PooledBy::kName it throws InputError where a surface has
/// no name.
ConditionClasses poolConditions(const std::vector<Recording>& recordings, PooledBy by = PooledBy::kCurvature);

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
  std::set<std::uint32_t> mounts =
      {};  ///< numbers of the mounts, 0 = not given; empty in a loaded calibration
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
