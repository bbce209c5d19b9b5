#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compensation/fit_scheme.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

// From sums to tables: the half of training that needs no bag, and that merging has in common with it.

/// Lays the tables out as the plan wants them, empty; layout, full scale and trained ranges stand in
/// `calibration` already.
void prepareTables(const compensation::SchemePlan& plan, Calibration& calibration);

/// Sets no_model: masked, or constant throughout a condition that a model trains on, of which it warns.
/// Throws InputError, as `origin`, where no taxel is left.
void findTaxelsWithoutModel(const compensation::SchemePlan& plan, const std::string& origin,
                            Calibration& calibration);

/// Whether a warning is one of findTaxelsWithoutModel().
bool isConstantTaxelWarning(const std::string& warning);

/// What is found from the data of the whole matrix before its taxels are trained: the regressor, put down in
/// `calibration` too, and what the scheme takes from them, put down in `plan`.
compensation::FoldRegressors choose(const CalibrationOptions& options, Calibration& calibration,
                                    compensation::SchemePlan& plan);

/// The sums of one taxel, by class and section.
compensation::SectionedReadings readingsOf(const compensation::TrainingStatistics& statistics,
                                           std::size_t taxel);

/// Fills the tables of one taxel from models in the plan's order; from none where it has no model.
void fillTables(const compensation::SchemePlan& plan, std::size_t taxel,
                const std::vector<regression::CrossValidatedModel>& models, Calibration& calibration);

/// All of it, for a mergeable regressor: what stands in `calibration` already is statistics, coverage,
/// masked, layout and the trained ranges but curvature. `origin` begins sentences.
void trainOnStatistics(const CalibrationOptions& options, const std::string& origin,
                       Calibration& calibration);

}  // namespace fsr::calibration
