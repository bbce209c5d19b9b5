#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/scheme.h"
#include "fsr_pressure_map/dataset/condition_classes.h"

namespace fsr::compensation {

/// What a scheme makes of a set of curvature classes: which classes each of its models trains on,
/// and which model answers a reading taken on a class. A scheme with a second input has a model for each
/// value of that input, all of them trained on all classes.
struct SchemePlan {
  struct Model {
    dataset::CurvatureClass answers_for;  ///< what the compiled tables say of the model
    std::vector<std::size_t> trained_on;  ///< indices of classes, ascending
  };
  Scheme scheme = Scheme::kPerCurvature;
  std::vector<dataset::CurvatureClass> classes;
  std::vector<Model> models;
  std::vector<std::size_t> model_of_class;
  /// scaled_curvature: distance in curvature at which a reading's weight falls by e^-1/2, as learnScheme()
  /// finds it [1/m]; 0 = standardised like the reading, as curvature_input.
  double curvature_scale = 0;

  /// Classes that a model both trains on and answers for, ascending: what it is tested on.
  std::vector<std::size_t> testedOn(std::size_t model) const;
};

/// curvature_ranges begins with a range for each class; learnScheme() merges them. Throws InputError where
/// the classes do not carry the scheme (flat_only without a flat class).
SchemePlan planScheme(Scheme scheme, const std::vector<dataset::CurvatureClass>& classes);

/// How the scheme's classes are formed.
dataset::PooledBy poolingOf(Scheme scheme);

/// One model for each of `ranges`, which hold each class once, in ascending order.
void planRanges(const std::vector<std::vector<std::size_t>>& ranges, SchemePlan& plan);

}  // namespace fsr::compensation
