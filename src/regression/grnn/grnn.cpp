#include "fsr_pressure_map/regression/grnn.h"

#include <sstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"
#include "regression/grnn/kernel_mean.h"
#include "regression/grnn/weighted_codes.h"
#include "regression/pressure_grid.h"

namespace fsr::regression {

namespace {

const settings::Range kBandwidthRange{1e-6, 1e3, "standard deviations of the readings"};
constexpr double kSigmaOfHalf = 0.84932180028801904;  // 1 / sqrt(2 ln 2)

GrnnOptions withBandwidth(double bandwidth) {
  GrnnOptions options;
  options.bandwidth = bandwidth;
  return options;
}

Fit fitWeighted(const WeightedCodes& samples, double deviation, const GrnnOptions& options) {
  if (samples.code.size() == 1) return constantFit(samples);
  const double sigma = sigmaOf(options);
  KernelMean mean = options.distance == KernelDistance::kSquared
                        ? gaussianMean(samples, sigma * deviation)
                        : laplaceMean(samples, 2 * sigma * sigma * deviation);
  return {std::move(mean.pressure), std::move(mean.weight)};
}

}  // namespace

void validate(const GrnnOptions& options) {
  if (kBandwidthRange.contains(options.bandwidth)) return;
  std::ostringstream text;
  text << "bandwidth is " << options.bandwidth << ", but must be " << kBandwidthRange.text();
  throw settings::InputError(text.str());
}

double sigmaOf(const GrnnOptions& options) {
  return options.spread == SpreadMeaning::kHalf ? kSigmaOfHalf * options.bandwidth : options.bandwidth;
}

Grnn::Grnn(double bandwidth) : Grnn(withBandwidth(bandwidth)) {}

Grnn::Grnn(const GrnnOptions& options) : options_(options) {
  validate(options);
}

Fit Grnn::fit(const CodeHistogram& training) const {
  if (!mergeable()) refuseSums();
  return fitWeighted(weightedCodes(training), readingDeviation(training), options_);
}

Fit Grnn::fitSamples(const CodeSamples& training) const {
  if (mergeable()) return Regressor::fitSamples(training);
  return fitWeighted(weightedByPressure(training), readingDeviation(histogramOf(training)), options_);
}

}  // namespace fsr::regression
