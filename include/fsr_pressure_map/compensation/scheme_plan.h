#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/scheme.h"
#include "fsr_pressure_map/compensation/training_statistics.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/regression/cross_validation.h"

namespace fsr {

/// What a scheme makes of a set of curvature classes: which classes each of its models trains on,
/// and which model answers a reading taken on a class.
struct SchemePlan {
  struct Model {
    CurvatureClass answers_for;           ///< what the compiled tables say of the model
    std::vector<std::size_t> trained_on;  ///< indices of classes, ascending
  };
  std::vector<Model> models;
  std::vector<std::size_t> model_of_class;
};

/// Throws InputError where the classes do not carry the scheme (flat_only without a flat class).
SchemePlan planScheme(Scheme scheme, const std::vector<CurvatureClass>& classes);

/// The models of one taxel, in the plan's order.
std::vector<CrossValidatedModel> fitTaxel(const SchemePlan& plan, const TrainingStatistics& statistics,
                                          std::size_t taxel, const Regressor& regressor,
                                          HeldOutDeviation held_out_deviation);

}  // namespace fsr
