#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/compensation/scheme.h"
#include "regression/code_statistics.h"
#include "regression/cross_validation.h"
#include "regression/regressor.h"
#include "regression/regressors.h"

namespace fsr::compensation {

/// The second input that `scheme` gives its model. Standard deviations are those of a sample, as MATLAB's
/// zscore, and weight each class by its number of readings. `scheme` must have a second input;
/// `bent` [classes] is used for kBinaryInput only.
regression::ClassInputs classInputs(Scheme scheme, const std::vector<double>& curvature,
                                    const std::vector<bool>& bent,
                                    const std::vector<std::uint64_t>& readings);

/// The models of a plan, trained on the readings of one taxel, in the plan's order. The answer for a reading
/// of code c taken on class k is
///
///     fits[plan.model_of_class[k]].pressure[c].
///
/// A model is empty if none of its classes has a reading. With a second input, all inputs are standardised by
/// mean and standard deviation over all readings given. If all readings are of one class, the second input is
/// constant and is left out.
///
/// Throws InputError as requireSchemeFor() does.
std::vector<regression::Fit> fitScheme(const SchemePlan& plan, std::size_t taxel,
                                       const regression::ClassReadings& readings,
                                       const regression::RegressorOptions& regressor);

/// The inputs that the plan's scheme gives a model with a second input.
regression::ClassInputs inputsOf(const SchemePlan& plan, std::size_t taxel,
                                 const regression::ClassReadings& readings,
                                 const regression::RegressorOptions& regressor);

/// Pressure of each code on class k [Pa]. For a class without readings it is computed from the other classes
/// by the rule of the scheme, as the live map would do (with `law` for curvature_map). `fits` are those of
/// fitScheme() for `readings`. Empty if there are no readings at all.
std::vector<double> answerOn(const SchemePlan& plan, std::size_t taxel,
                             const regression::ClassReadings& readings,
                             const std::vector<regression::Fit>& fits, std::size_t k,
                             const EffectLaw& law = {});

/// The rule that computes the table of any curvature from the tables of the classes.
BlendRule blendOf(Scheme scheme, const regression::RegressorOptions& regressor);

/// Throws InputError if the scheme cannot be combined with this regressor, with a list of the regressors that
/// it can be combined with. What a regressor can do stands in its entry (regression/regressors.h):
/// curvature_input and binary_input need a second input, one_hot one of several columns, and scaled_curvature
/// a kernel.
void requireSchemeFor(Scheme scheme, const regression::RegressorOptions& regressor);

/// The readings of one taxel by class and section.
struct SectionedReadings {
  std::uint16_t full_scale = 0;
  std::vector<std::vector<regression::CodeStatistics>> sums;  ///< [classes][sections]
  std::vector<std::vector<regression::CodeSamples>>
      samples;  ///< likewise; empty if the regressor needs sums only
};

regression::ClassReadings allSections(const SectionedReadings& readings);

/// The regressor to train with. Options that are chosen from the data are chosen again without the held-out
/// section.
struct FoldRegressors {
  regression::RegressorOptions whole;
  std::vector<regression::RegressorOptions> without;  ///< [sections]; empty = `whole` throughout

  const regression::RegressorOptions& at(std::size_t left_out) const {
    return left_out < without.size() ? without[left_out] : whole;
  }
};

/// Trains the models of the plan on all sections, and once without each section. The deviation of a model
/// comes from the classes that it is tested on.
std::vector<regression::CrossValidatedModel> crossValidateScheme(
    const SchemePlan& plan, std::size_t taxel, const SectionedReadings& readings,
    const FoldRegressors& regressors, regression::HeldOutDeviation held_out_deviation);
/// The same with one regressor throughout.
std::vector<regression::CrossValidatedModel> crossValidateScheme(
    const SchemePlan& plan, std::size_t taxel, const SectionedReadings& readings,
    const regression::RegressorOptions& regressor, regression::HeldOutDeviation held_out_deviation);

}  // namespace fsr::compensation
