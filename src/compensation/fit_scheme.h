#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/class_input.h"
#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/compensation/curvature_rule.h"
#include "regression/class_readings.h"
#include "regression/cross_validation.h"
#include "regression/regressors.h"

namespace fsr::compensation {

/// The models of a plan, trained on the readings of one taxel, in the plan's order. A reading of code c
/// taken on class k has the answer
///
///     fits[plan.model_of_class[k]].pressure[c].
///
/// A model of which no class has a reading comes back empty. With a second input, every input is standardised
/// by its mean and deviation over all readings given; where they all are of one class, the second input
/// has nothing to say and is left out.
///
/// Throws InputError as requireSchemeFor() does.
std::vector<regression::Fit> fitScheme(const SchemePlan& plan, std::size_t taxel,
                                       const regression::ClassReadings& readings,
                                       const regression::RegressorOptions& regressor);

/// The inputs that the plan's scheme gives a model with a second input.
regression::ClassInputs inputsOf(const SchemePlan& plan, std::size_t taxel,
                                 const regression::ClassReadings& readings,
                                 const regression::RegressorOptions& regressor);

/// Pressure of each code on class k [Pa], whether it had readings or not: of a class without any, by the
/// scheme's rule from the classes that had some, as the live map would answer there (with `law` for
/// curvature_map). `fits` as fitScheme() made them of `readings`. Empty where there are no readings at all.
std::vector<double> answerOn(const SchemePlan& plan, std::size_t taxel,
                             const regression::ClassReadings& readings,
                             const std::vector<regression::Fit>& fits, std::size_t k,
                             const EffectLaw& law = {});

/// How tables of a plan's classes become the table of any curvature.
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
      samples;  ///< likewise; empty where the regressor needs none
};

regression::ClassReadings allSections(const SectionedReadings& readings);

/// The regressor to train with: what is chosen from the data is chosen anew without the section held out.
struct FoldRegressors {
  regression::RegressorOptions whole;
  std::vector<regression::RegressorOptions> without;  ///< [sections]; empty = `whole` throughout

  const regression::RegressorOptions& at(std::size_t left_out) const {
    return left_out < without.size() ? without[left_out] : whole;
  }
};

/// Trains the plan's models on all sections and, once for each, without it. Deviations of a model come from
/// the classes that it is tested on.
std::vector<regression::CrossValidatedModel> crossValidateScheme(
    const SchemePlan& plan, std::size_t taxel, const SectionedReadings& readings,
    const FoldRegressors& regressors, regression::HeldOutDeviation held_out_deviation);
/// The same with one regressor throughout.
std::vector<regression::CrossValidatedModel> crossValidateScheme(
    const SchemePlan& plan, std::size_t taxel, const SectionedReadings& readings,
    const regression::RegressorOptions& regressor, regression::HeldOutDeviation held_out_deviation);

}  // namespace fsr::compensation
