#include "regression/regressor.h"

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {

Fit Regressor::fitSamples(const CodeSamples& training) const {
  const CodeHistogram histogram = histogramOf(training);
  return fit(histogram);
}

void Regressor::refuseSums() const {
  throw settings::InputError(
      "model " + name() +
      " needs the bags themselves: the sums that a calibration file keeps do not suffice");
}

}  // namespace fsr::regression
