#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/scheme.h"
#include "fsr_pressure_map/dataset/condition_classes.h"

namespace fsr::compensation {

/// The models of a scheme for a set of curvature classes: the classes that each model is trained on, and the
/// model that answers for each class. A scheme with a second input has a model for each value of that input;
/// all of them are trained on all classes.
struct SchemePlan {
  struct Model {
    dataset::CurvatureClass answers_for;  ///< the class that the tables name for the model
    std::vector<std::size_t> trained_on;  ///< indices of classes, ascending
  };
  Scheme scheme = Scheme::kPerCurvature;
  std::vector<dataset::CurvatureClass> classes;
  std::vector<Model> models;
  std::vector<std::size_t> model_of_class;
  /// scaled_curvature: distance in curvature at which the weight of a reading decreases by the factor e^-1/2,
  /// found by learnScheme() [1/m]; 0 = standardised like the reading, as in curvature_input.
  double curvature_scale = 0;

  /// Whether the model that answers for a class is trained on it.
  bool trainsOn(std::size_t curvature_class) const;
  /// Classes that a model is trained on and answers for, ascending. It is tested on these.
  std::vector<std::size_t> testedOn(std::size_t model) const;
};

/// For curvature_ranges the plan has one range for each class, which learnScheme() merges. Throws InputError
/// if the scheme is not possible with these classes (flat_only without a flat class).
SchemePlan planScheme(Scheme scheme, const std::vector<dataset::CurvatureClass>& classes);

/// Whether the classes of the scheme are formed by curvature or by name.
dataset::PooledBy poolingOf(Scheme scheme);

/// One model for each of `ranges`, which contain each class once, in ascending order.
void planRanges(const std::vector<std::vector<std::size_t>>& ranges, SchemePlan& plan);

}  // namespace fsr::compensation
