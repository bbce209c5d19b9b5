#pragma once

#include <vector>

#include "fsr_pressure_map/compensation/curvature_rule.h"
#include "regression/regressors.h"
#include "study/fold.h"
#include "study/study_method.h"

namespace fsr::study {

/// What a method trains in one fold: its regressor, and what its scheme has learned from the training
/// readings of the whole matrix.
struct FoldModel {
  compensation::SchemePlan plan;
  regression::RegressorOptions regressor;
  compensation::EffectLaw law;
};

regression::RegressorOptions grnnOf(const regression::GrnnOptions& options, double bandwidth);

/// A model that learns nothing beyond its readings: the paper's.
FoldModel plainModel(const StudyMethod& method, const regression::RegressorOptions& regressor);

/// Lets the scheme learn (length scale, ranges, law) from the fold's training cells, for those that do.
/// Length scale and ranges are learned on about plan.bandwidth_taxels taxels, a law on all.
FoldModel learnedModel(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                       const Fold& fold, double bandwidth, const StudyPlan& plan);

/// Pressure of every code on each class of `asked` [Pa], by one taxel's training readings.
std::vector<std::vector<double>> answersOf(const FoldModel& model, std::size_t taxel,
                                           const regression::ClassReadings& training,
                                           const std::vector<std::size_t>& asked);

/// Every n-th of the taxels that take part, about plan.bandwidth_taxels of them.
std::vector<std::size_t> someTaxels(const StudyData& data, const StudyPlan& plan);

}  // namespace fsr::study
