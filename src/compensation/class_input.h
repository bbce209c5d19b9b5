#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/compensation/scheme.h"
#include "regression/class_inputs.h"

namespace fsr::compensation {

/// The second input that `scheme` gives its model. Standard deviations are those of a sample, as MATLAB's
/// zscore, and weight each class by its number of readings. `scheme` must have a second input;
/// `bent` [classes] is used for kBinaryInput only.
regression::ClassInputs classInputs(Scheme scheme, const std::vector<double>& curvature,
                                    const std::vector<bool>& bent,
                                    const std::vector<std::uint64_t>& readings);

}  // namespace fsr::compensation
