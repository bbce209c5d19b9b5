#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compensation/fit_scheme.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

// From sums to tables: the part of training that needs no bags. Merging uses it too.

/// Gives the tables the size that the plan needs, empty. Layout, full scale and trained ranges must be in
/// `calibration`.
void prepareTables(const compensation::SchemePlan& plan, Calibration& calibration);

/// Sets no_model for taxels that are masked, or that are constant throughout a condition that a model is
/// trained on; the latter with a warning. Throws InputError that starts with `origin` if no taxel is left.
void findTaxelsWithoutModel(const compensation::SchemePlan& plan, const std::string& origin,
                            Calibration& calibration);

/// Whether a warning is one of findTaxelsWithoutModel().
bool isConstantTaxelWarning(const std::string& warning);

/// Finds what depends on the data of the whole matrix before its taxels are trained: the regressor, which is
/// also stored in `calibration`, and the parameters of the scheme, which are stored in `plan`.
compensation::FoldRegressors choose(const CalibrationOptions& options, Calibration& calibration,
                                    compensation::SchemePlan& plan, const CalibrationProgress& progress);

/// The sums of one taxel by class and section.
compensation::SectionedReadings readingsOf(const compensation::TrainingStatistics& statistics,
                                           std::size_t taxel);

/// Fills the tables of one taxel from models in the plan's order. No models: the taxel has none.
void fillTables(const compensation::SchemePlan& plan, std::size_t taxel,
                const std::vector<regression::CrossValidatedModel>& models, Calibration& calibration);

/// The complete training of a mergeable regressor. `calibration` must have statistics, coverage, masked,
/// layout, and the trained ranges except curvature. Error messages start with `origin`.
void trainOnStatistics(const CalibrationOptions& options, const std::string& origin,
                       Calibration& calibration);

}  // namespace fsr::calibration
