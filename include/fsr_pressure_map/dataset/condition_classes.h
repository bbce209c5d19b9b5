#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// One curvature class: conditions whose curvature agrees, from any number of bags.
struct CurvatureClass {
  std::string surface;            ///< name of the condition it was trained on, e.g. cylinder_7cm
  std::vector<double> curvature;  ///< principal curvature, one for all taxels or one each, row-major [1/m]

  double at(std::size_t taxel) const {
    return curvature.size() == 1 ? curvature.front() : curvature.at(taxel);
  }
};

/// Largest |principal curvature| of a surface that counts as flat: a radius of 4 m [1/m].
constexpr double kFlatCurvature = 0.25;
/// Conditions whose curvature differs by no more than this at any taxel are one class [1/m].
constexpr double kSameClassCurvature = 0.25;

/// Flat at every taxel.
bool isFlat(const CurvatureClass& curvature_class);

/// One condition of one recording, as pooling sees it.
struct RecordedCondition {
  CurvatureClass condition;
  std::uint64_t scans = 0;
};

/// What makes conditions one class.
enum class PooledBy {
  kCurvature,  ///< agreement to kSameClassCurvature at every taxel
  kName,       ///< the surface's name
};

/// Conditions pooled into classes.
struct PooledConditions {
  std::vector<CurvatureClass> classes;  ///< by ascending curvature of taxel 0
  std::vector<std::size_t> class_of;    ///< of each condition, index into `classes`
};

/// Name and curvature of a class are those of its member with the most scans. The classes do not depend
/// on the order of the conditions.
PooledConditions poolConditions(const std::vector<RecordedCondition>& conditions,
                                PooledBy by = PooledBy::kCurvature);

/// The conditions of a recording, in its order. Throws InputError where one is of unknown curvature.
std::vector<RecordedCondition> conditionsOf(const Recording& recording);

/// The conditions of several recordings, pooled.
struct ConditionClasses {
  /// By ascending curvature of taxel 0.
  std::vector<CurvatureClass> classes;
  /// [recordings][conditions of that recording] -> index into `classes`.
  std::vector<std::vector<std::size_t>> class_of;
};

/// The same for recordings. By name it throws InputError where a surface has none.
ConditionClasses poolConditions(const std::vector<Recording>& recordings, PooledBy by = PooledBy::kCurvature);

}  // namespace fsr::dataset
