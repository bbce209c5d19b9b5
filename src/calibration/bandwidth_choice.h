#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/fit_scheme.h"
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

}  // namespace fsr::calibration
