#include <numeric>

#include "regression/grnn/weighted_codes.h"
#include "regression/regressors.h"
#include "regression/second_input.h"

namespace fsr::regression {

namespace {

struct Line {
  double mean_code = 0;
  double mean_pressure = 0;  // [Pa]
  double slope = 0;          // [Pa a count]
  double scatter = 0;        // sum of (code - mean code)^2
};

// Sums about the means, so that a narrow range of large codes loses no precision.
Line leastSquares(const WeightedCodes& samples) {
  Line line;
  for (std::size_t i = 0; i < samples.code.size(); ++i) {
    line.mean_code += samples.count[i] * static_cast<double>(samples.code[i]) / samples.samples;
  }
  line.mean_pressure = std::accumulate(samples.sum.begin(), samples.sum.end(), 0.0) / samples.samples;
  double products = 0;
  for (std::size_t i = 0; i < samples.code.size(); ++i) {
    const double from_mean = static_cast<double>(samples.code[i]) - line.mean_code;
    products += from_mean * (samples.sum[i] - samples.count[i] * line.mean_pressure);
    line.scatter += samples.count[i] * from_mean * from_mean;
  }
  line.slope = products / line.scatter;
  return line;
}

// Ordinary least squares of pressure on the reading, the paper's simplest model (Ahmadizadeh and Menon 2019,
// doi:10.3390/s19245519):
//
//     f(c) = mean P + b (c - mean c),   b = sum (c_i - mean c) P_i / sum (c_i - mean c)^2.
//
// The line is not limited to the codes of training nor to positive pressure: clipping it would hide that the
// curve of a sensor is not straight. The sums of each code are sufficient, so merging is exact.
//
// If all readings are equal, there is no slope, and the answer is their mean pressure everywhere.
//
// `support` is 1 / leverage: the number of samples whose mean would have the variance of the line at that
// code. It is N at the mean reading and decreases to both sides.
class LinearRegression : public Regressor {
 public:
  std::string name() const override { return "linear"; }
  Fit fit(const CodeHistogram& training) const override {
    const WeightedCodes samples = weightedCodes(training);
    if (samples.code.size() == 1) return constantFit(samples);
    const Line line = leastSquares(samples);
    Fit fit{std::vector<double>(samples.table_size), std::vector<double>(samples.table_size)};
    for (std::size_t code = 0; code < samples.table_size; ++code) {
      const double from_mean = static_cast<double>(code) - line.mean_code;
      fit.pressure[code] = line.mean_pressure + line.slope * from_mean;
      fit.support[code] = 1.0 / (1.0 / samples.samples + from_mean * from_mean / line.scatter);
    }
    return fit;
  }
};

}  // namespace

RegressorEntry linearEntry() {
  RegressorEntry entry;
  entry.name = "linear";
  entry.summary = "straight line by least squares";
  entry.make = [](const RegressorOptions&) -> std::unique_ptr<Regressor> {
    return std::make_unique<LinearRegression>();
  };
  SecondInput input;
  input.fit = [](const ClassReadings& readings, const ClassInputs& inputs, const RegressorOptions&) {
    return fitLinearOnInput(readings, inputs);
  };
  input.between = BetweenInputs::kStraight;
  input.several_columns = true;
  entry.second_input = input;
  return entry;
}

}  // namespace fsr::regression
