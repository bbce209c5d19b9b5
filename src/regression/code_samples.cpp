#include "regression/code_samples.h"

#include <algorithm>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {

void CodeSamples::append(const CodeSamples& other) {
  code.insert(code.end(), other.code.begin(), other.code.end());
  pressure.insert(pressure.end(), other.pressure.begin(), other.pressure.end());
  curvature.insert(curvature.end(), other.curvature.begin(), other.curvature.end());
}

void validate(const CodeSamples& samples) {
  const bool curvature_fits = samples.curvature.empty() || samples.curvature.size() == samples.size();
  if (samples.pressure.size() != samples.size() || !curvature_fits) {
    throw settings::InputError(
        "training readings are " + std::to_string(samples.size()) + " codes with " +
        std::to_string(samples.pressure.size()) + " pressures and " +
        std::to_string(samples.curvature.size()) +
        " curvatures, but each code must have a pressure, and a curvature each or none");
  }
  const auto highest = std::max_element(samples.code.begin(), samples.code.end());
  if (highest != samples.code.end() && *highest > samples.full_scale) {
    throw settings::InputError("a count is " + std::to_string(*highest) +
                               ", but the converter's full scale is " + std::to_string(samples.full_scale));
  }
}

CodeStatistics statisticsOf(const CodeSamples& samples) {
  validate(samples);
  CodeAccumulator accumulator(samples.full_scale);
  for (std::size_t i = 0; i < samples.size(); ++i) accumulator.add(samples.code[i], samples.pressure[i]);
  return accumulator.take();
}

CodeHistogram histogramOf(const CodeSamples& samples) {
  validate(samples);
  CodeHistogram histogram(samples.full_scale);
  for (std::size_t i = 0; i < samples.size(); ++i) histogram.add(samples.code[i], samples.pressure[i]);
  return histogram;
}

}  // namespace fsr::regression
