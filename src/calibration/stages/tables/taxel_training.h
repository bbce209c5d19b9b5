#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compensation/fit_scheme.h"
#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Whether these options ask for a bandwidth chosen from the data.
bool choosesBandwidth(const CalibrationOptions& options);

/// The regressor of a calibration. If the bandwidth is to be chosen, all taxels and models share one, in
/// standard deviations of the readings. It is the one with the least squared errors on held-out sections,
/// summed over up to kTaxelsOfSearch taxels that are spread evenly over those with a model; each model of the
/// plan is tested on the classes that it answers for. The bandwidth of the model without a section is chosen
/// without that section (nested cross-validation).
///
/// For a GRNN with equal weights of pressure bins it is the bandwidth found with equal weights of all
/// readings. `no_model` [taxels], 1 = has no model. `progress` is told of the search.
compensation::FoldRegressors chooseRegressor(const CalibrationOptions& options,
                                             const compensation::SchemePlan& plan,
                                             const compensation::TrainingStatistics& statistics,
                                             const std::vector<std::uint8_t>& no_model,
                                             const CalibrationProgress& progress);

constexpr std::size_t kTaxelsOfSearch = 16;

/// Up to kTaxelsOfSearch of the taxels that have a model, evenly spread.
std::vector<std::size_t> taxelsOfSearch(const std::vector<std::uint8_t>& no_model);

/// Computes the rule of calibration.tables: length scale, law, and the uncertainty for a curvature that was
/// not in training. Everything else in the tables, the statistics and the regressor must be complete. Returns
/// the errors from which the uncertainty was found.
UnseenScore learnRule(const compensation::SchemePlan& plan, unsigned threads, Calibration& calibration);

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
