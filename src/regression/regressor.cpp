#include "regression/regressor.h"

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {

Fit Regressor::fitSamples(const CodeSamples& training) const {
  const CodeHistogram histogram = histogramOf(training);
  return fit(histogram);
}

void Regressor::refuseSums() const {
  throw settings::InputError("model " + name() +
                             " needs the bags; the sums in a calibration file are not sufficient");
}

}  // namespace fsr::regression
