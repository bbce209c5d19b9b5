#include "regression/grnn/grnn.h"

#include <sstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"
#include "regression/grnn/kernel_mean.h"
#include "regression/grnn/weighted_codes.h"
#include "regression/regressors.h"
#include "regression/second_input.h"

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

bool isPlainKernel(const RegressorOptions& options) {
  return options.grnn.distance == KernelDistance::kSquared &&
         options.grnn.weighting == SampleWeighting::kEachSample;
}

SecondInput grnnSecondInput() {
  SecondInput input;
  input.fit = [](const ClassReadings& readings, const ClassInputs& inputs, const RegressorOptions& options) {
    return fitGrnnOnInput(readings, inputs, options.grnn);
  };
  input.between = BetweenInputs::kKernel;
  input.several_columns = true;
  input.permitted = isPlainKernel;
  input.condition = "the squared distance and samples of equal weight";
  input.sigma = [](const RegressorOptions& options) { return sigmaOf(options.grnn); };
  input.kernels = [](const ClassReadings& readings, const RegressorOptions& options) {
    return classKernels(readings, options.grnn);
  };
  return input;
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

RegressorEntry grnnEntry() {
  RegressorEntry entry;
  entry.name = "grnn";
  entry.summary = "general regression neural network (Specht 1991), a Gaussian kernel mean";
  entry.make = [](const RegressorOptions& options) -> std::unique_ptr<Regressor> {
    return std::make_unique<Grnn>(options.grnn);
  };
  entry.write = [](const RegressorOptions& options,
                   OptionWriter& writer) {  // the bandwidth is stored with the model's name
    writer.text("spread", spreadName(options.grnn.spread));
    writer.text("distance", distanceName(options.grnn.distance));
    writer.text("weighting", weightingName(options.grnn.weighting));
  };
  entry.read = [](const OptionReader& reader, RegressorOptions& options) {
    options.grnn.spread = spreadFromName(reader.text("spread"));
    options.grnn.distance = distanceFromName(reader.text("distance"));
    options.grnn.weighting = weightingFromName(reader.text("weighting"));
  };
  entry.in_every_file = true;
  entry.second_input = grnnSecondInput();
  return entry;
}

}  // namespace fsr::regression
