#pragma once

#include <cstddef>
#include <vector>

namespace fsr::regression {

/// The second input of a model: one value, of one or more columns, for each curvature class.
struct ClassInputs {
  /// [classes][columns], not standardised: the curvature [1/m], or a one for the class among zeros (one-hot),
  /// or 0 for flat and 1 for bent.
  std::vector<std::vector<double>> columns;
  /// 1 / standard deviation of each column over the training readings; 0 for a constant column.
  std::vector<double> scale;

  /// Squared distance between two classes in standardised units.
  double squaredDistance(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t i = 0; i < scale.size(); ++i) {
      const double difference = (columns[a][i] - columns[b][i]) * scale[i];
      sum += difference * difference;
    }
    return sum;
  }
};

}  // namespace fsr::regression
