#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/compensation/scheme.h"

namespace fsr::compensation {

/// What a model with a second input sees of the curvature classes.
struct ClassInputs {
  /// The input's columns of each class, unstandardised: the curvature [1/m], a one for the class among
  /// zeros, or 0 for flat and 1 for bent.
  std::vector<std::vector<double>> columns;
  /// 1 / deviation of each column over the training readings; 0 for a column that never changes.
  std::vector<double> scale;

  /// Squared distance of two classes in standardised units.
  double squaredDistance(std::size_t a, std::size_t b) const;
};

/// Deviations (of a sample, as MATLAB's zscore) weigh each class with its number of readings. `scheme` has a
/// second input; `bent` [classes] is looked at for kBinaryInput only.
ClassInputs classInputs(Scheme scheme, const std::vector<double>& curvature, const std::vector<bool>& bent,
                        const std::vector<std::uint64_t>& readings);

}  // namespace fsr::compensation
