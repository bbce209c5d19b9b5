#pragma once

#include <vector>

#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "regression/regressors.h"
#include "study/fold.h"
#include "study/study_method.h"

namespace fsr::study {

/// A method as trained in one fold: its regressor, and the parameters that its scheme has learned from the
/// training readings of the whole matrix.
struct FoldModel {
  compensation::SchemePlan plan;
  regression::RegressorOptions regressor;
  compensation::EffectLaw law;
};

regression::RegressorOptions grnnOf(const regression::GrnnOptions& options, double bandwidth);

/// A model without learned parameters, as in the paper.
FoldModel plainModel(const StudyMethod& method, const regression::RegressorOptions& regressor);

/// A model whose scheme has learned its length scale, curvature ranges or curvature law from the fold's
/// training cells, if the scheme has any. Length scale and ranges are learned on about plan.bandwidth_taxels
/// taxels, a law on all taxels.
FoldModel learnedModel(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                       const Fold& fold, double bandwidth, const StudyPlan& plan);

/// Pressure of every code for each of `classes` [classes][codes] [Pa], fitted to one taxel's training
/// readings.
std::vector<std::vector<double>> tablesFor(const FoldModel& model, std::size_t taxel,
                                           const regression::ClassReadings& training,
                                           const std::vector<std::size_t>& classes);

/// Every n-th of the studied taxels, about plan.bandwidth_taxels in all.
std::vector<std::size_t> taxelSample(const StudyData& data, const StudyPlan& plan);

}  // namespace fsr::study
