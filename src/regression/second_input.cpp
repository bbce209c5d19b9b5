#include "regression/second_input.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "regression/grnn/vector_width.h"
#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

namespace {

// In a larger sum nothing that matters has underflowed: gaussianMean() ignores values below exp(-600), and
// products underflow below exp(-700).
const double kSafeWeight = std::exp(-500.0);
// Weights below exp(-40) of the largest are ignored.
constexpr double kNegligibleExponent = 40.0;
// Upper limit for the logarithm of the number of readings of a class, each of weight 1 at most.
constexpr double kLargestLogWeight = 40.0;
constexpr std::size_t kCodesInCache = 512;

double logWeight(const KernelMean& mean, std::size_t code) {
  return mean.weight[code] > 0 ? std::log(mean.weight[code]) : mean.log_weight[code];
}

// The answer at one code, computed with logarithms. `log_weight` [K] is memory for them. `nearest` is the
// class with the smallest exponent; starting from it, most others can be skipped.
double byLogarithms(const std::vector<KernelMean>& classes, const std::vector<double>& exponent,
                    std::size_t nearest, std::size_t code, std::vector<double>& log_weight) {
  double largest = logWeight(classes[nearest], code) - exponent[nearest];
  for (std::size_t k = 0; k < classes.size(); ++k) {
    log_weight[k] = -INFINITY;
    if (kLargestLogWeight - exponent[k] < largest - kNegligibleExponent) continue;
    log_weight[k] = logWeight(classes[k], code) - exponent[k];
    largest = std::max(largest, log_weight[k]);
  }
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const double below = largest - log_weight[k];
    if (below > kNegligibleExponent) continue;
    const double share = std::exp(-below);
    sum += share * classes[k].pressure[code];
    weight += share;
  }
  return sum / weight;
}

// Adds the contribution of one class at `codes` codes.
FSR_EACH_VECTOR_WIDTH
void addClass(const double* __restrict__ pressure, const double* __restrict__ weight, double factor,
              std::size_t codes, double* __restrict__ sum, double* __restrict__ share) {
  for (std::size_t code = 0; code < codes; ++code) {
    const double own = factor * weight[code];
    sum[code] += own * pressure[code];
    share[code] += own;
  }
}

FSR_EACH_VECTOR_WIDTH
void divide(const double* __restrict__ share, std::size_t codes, double* __restrict__ sum) {
  for (std::size_t code = 0; code < codes; ++code) sum[code] /= share[code];
}

}  // namespace

Fit blendKernels(const std::vector<KernelMean>& classes, const std::vector<double>& exponent) {
  const std::size_t codes = classes.front().pressure.size();
  Fit fit{std::vector<double>(codes, 0.0), std::vector<double>(codes, 0.0)};
  std::vector<double> factor;
  for (const double x : exponent) factor.push_back(std::exp(-x));
  for (std::size_t begin = 0; begin < codes; begin += kCodesInCache) {
    const std::size_t number = std::min(codes - begin, kCodesInCache);
    for (std::size_t k = 0; k < classes.size(); ++k) {
      if (factor[k] == 0) continue;
      addClass(classes[k].pressure.data() + begin, classes[k].weight.data() + begin, factor[k], number,
               fit.pressure.data() + begin, fit.support.data() + begin);
    }
    divide(fit.support.data() + begin, number, fit.pressure.data() + begin);
  }
  const auto nearest =
      static_cast<std::size_t>(std::min_element(exponent.begin(), exponent.end()) - exponent.begin());
  std::vector<double> log_weight(classes.size());
  for (std::size_t code = 0; code < codes; ++code) {
    if (!(fit.support[code] > kSafeWeight)) {
      fit.pressure[code] = byLogarithms(classes, exponent, nearest, code, log_weight);
    }
  }
  return fit;
}

namespace {

CodeHistogram pooled(const ClassReadings& readings) {
  CodeHistogram all(readings.full_scale);
  for (const CodeHistogram& sums : readings.sums) all.add(sums);
  return all;
}

// Classes with equal inputs form one group, i.e. one value of the second input.
struct Groups {
  std::vector<std::size_t> group_of_class;
  std::vector<std::vector<std::size_t>> classes;  // of each group
};

Groups groupsOf(const ClassInputs& inputs) {
  Groups groups;
  for (std::size_t k = 0; k < inputs.columns.size(); ++k) {
    std::size_t g = 0;
    while (g < groups.classes.size() && inputs.columns[groups.classes[g].front()] != inputs.columns[k]) ++g;
    if (g == groups.classes.size()) groups.classes.emplace_back();
    groups.classes[g].push_back(k);
    groups.group_of_class.push_back(g);
  }
  return groups;
}

WeightedCodes samplesOf(const std::vector<std::size_t>& classes, const ClassReadings& readings) {
  if (classes.size() == 1) return weightedCodes(readings.sums[classes.front()]);
  CodeHistogram sums(readings.full_scale);
  for (const std::size_t k : classes) sums.add(readings.sums[k]);
  return weightedCodes(sums);
}

// Sums of products of the standardised inputs (reading, then columns) and of the pressure, about their means.
struct Moments {
  double readings = 0;
  double mean_code = 0, code_scale = 0;  // 1 / deviation
  double mean_pressure = 0;              // [Pa]
  std::vector<Eigen::VectorXd> columns;  // of each class, standardised
  Eigen::MatrixXd products;
  Eigen::VectorXd with_pressure;  // [Pa]
};

// Standardised columns of each class, minus their mean over the readings.
std::vector<Eigen::VectorXd> standardised(const ClassReadings& readings, const ClassInputs& inputs) {
  const auto number = static_cast<Eigen::Index>(inputs.scale.size());
  const Eigen::Map<const Eigen::VectorXd> scale(inputs.scale.data(), number);
  std::vector<Eigen::VectorXd> columns;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(number);
  double all = 0;
  for (std::size_t k = 0; k < readings.sums.size(); ++k) {
    const Eigen::Map<const Eigen::VectorXd> raw(inputs.columns[k].data(), number);
    columns.emplace_back(raw.cwiseProduct(scale));
    mean += static_cast<double>(readings.readings(k)) * columns.back();
    all += static_cast<double>(readings.readings(k));
  }
  for (Eigen::VectorXd& column : columns) column -= mean / all;
  return columns;
}

Moments momentsOf(const ClassReadings& readings, const ClassInputs& inputs) {
  Moments m;
  const WeightedCodes all = weightedCodes(pooled(readings));
  const double deviation = readingDeviation(pooled(readings));
  m.readings = all.samples;
  m.code_scale = deviation > 0 ? 1.0 / deviation : 0.0;
  for (std::size_t i = 0; i < all.code.size(); ++i) {
    m.mean_code += all.count[i] * all.code[i] / m.readings;
    m.mean_pressure += all.sum[i] / m.readings;
  }
  m.columns = standardised(readings, inputs);
  const auto size = static_cast<Eigen::Index>(inputs.scale.size()) + 1;
  m.products = Eigen::MatrixXd::Zero(size, size);
  m.with_pressure = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd row(size);
  for (std::size_t k = 0; k < readings.sums.size(); ++k) {
    const WeightedCodes samples = weightedCodes(readings.sums[k]);
    row.tail(size - 1) = m.columns[k];
    for (std::size_t i = 0; i < samples.code.size(); ++i) {
      row[0] = (samples.code[i] - m.mean_code) * m.code_scale;
      m.products += samples.count[i] * row * row.transpose();
      m.with_pressure += (samples.sum[i] - samples.count[i] * m.mean_pressure) * row;
    }
  }
  return m;
}

CodeSamples withInput(const ClassReadings& readings, const ClassInputs& inputs) {
  CodeSamples all;
  all.full_scale = readings.full_scale;
  for (std::size_t k = 0; k < readings.samples.size(); ++k) {
    CodeSamples of_class = readings.samples[k];
    of_class.curvature.assign(of_class.size(), inputs.columns[k].front());
    all.append(of_class);
  }
  return all;
}

}  // namespace

std::vector<KernelMean> classKernels(const ClassReadings& readings, const GrnnOptions& options) {
  const double sigma = sigmaOf(options) * readingDeviation(pooled(readings));
  std::vector<KernelMean> means;
  for (const CodeHistogram& sums : readings.sums) {
    means.push_back(gaussianMean(weightedCodes(sums), sigma, LogWeight::kYes));
  }
  return means;
}

std::vector<Fit> fitGrnnOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                const GrnnOptions& options) {
  const CodeHistogram all = pooled(readings);
  const double deviation = readingDeviation(all);
  if (deviation == 0) return std::vector<Fit>(readings.classes(), constantFit(weightedCodes(all)));
  const Groups groups = groupsOf(inputs);
  const double sigma = sigmaOf(options), precision = 0.5 / (sigma * sigma);
  std::vector<KernelMean> means;
  std::vector<std::size_t> class_of_mean;
  for (const std::vector<std::size_t>& classes : groups.classes) {
    const WeightedCodes samples = samplesOf(classes, readings);
    if (samples.code.empty()) continue;
    means.push_back(gaussianMean(samples, sigma * deviation, LogWeight::kWhereZero));
    class_of_mean.push_back(classes.front());
  }
  std::vector<Fit> fits;
  for (std::size_t asked = 0; asked < groups.group_of_class.size(); ++asked) {
    const std::size_t first = groups.classes[groups.group_of_class[asked]].front();
    if (first < asked) {
      fits.push_back(fits[first]);
      continue;
    }
    std::vector<double> exponent;
    for (const std::size_t k : class_of_mean) {
      exponent.push_back(precision * inputs.squaredDistance(asked, k));
    }
    fits.push_back(blendKernels(means, exponent));
  }
  return fits;
}

std::vector<Fit> fitLinearOnInput(const ClassReadings& readings, const ClassInputs& inputs) {
  const Moments m = momentsOf(readings, inputs);
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(m.products);
  const Eigen::VectorXd slopes = solver.solve(m.with_pressure);
  const Eigen::MatrixXd inverse = solver.pseudoInverse();
  std::vector<Fit> fits;
  Eigen::VectorXd row(slopes.size());
  for (const Eigen::VectorXd& columns : m.columns) {
    row.tail(columns.size()) = columns;
    Fit fit;
    for (std::size_t code = 0; code <= readings.full_scale; ++code) {
      row[0] = (static_cast<double>(code) - m.mean_code) * m.code_scale;
      fit.pressure.push_back(m.mean_pressure + slopes.dot(row));
      fit.support.push_back(1.0 / (1.0 / m.readings + row.dot(inverse * row)));
    }
    fits.push_back(std::move(fit));
  }
  return fits;
}

std::vector<Fit> fitForestOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                  const ForestOptions& options) {
  const CurvatureSteps steps = fitCurvatureForest(withInput(readings, inputs), options);
  std::vector<Fit> fits;
  for (const std::vector<double>& columns : inputs.columns) fits.push_back(steps.at(columns.front()));
  return fits;
}

}  // namespace fsr::regression
