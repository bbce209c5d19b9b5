#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/fit_scheme.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Whether there is a bandwidth to choose.
bool choosesBandwidth(const CalibrationOptions& options);

/// The regressor of a calibration. Where the bandwidth is to be chosen, all taxels and models share one, in
/// deviations of the readings: that of the least squared errors on held-out sections, each model of the
/// plan counting with the classes that it is tested on, summed over up to kTaxelsOfSearch taxels spread
/// evenly over those with a model. The model without a section has a bandwidth chosen without it (nested
/// cross-validation).
///
/// Of a GRNN that weighs pressure bins alike it is the bandwidth found with all readings alike. `no_model`
/// has one value for each taxel, 1 = has none.
compensation::FoldRegressors chooseRegressor(const CalibrationOptions& options,
                                             const compensation::SchemePlan& plan,
                                             const compensation::TrainingStatistics& statistics,
                                             const std::vector<std::uint8_t>& no_model);

constexpr std::size_t kTaxelsOfSearch = 16;

/// Up to kTaxelsOfSearch of the taxels that have a model, evenly spread.
std::vector<std::size_t> taxelsOfSearch(const std::vector<std::uint8_t>& no_model);

}  // namespace fsr::calibration
