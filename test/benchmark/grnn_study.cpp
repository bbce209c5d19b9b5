#include "benchmark/grnn_study.h"

#include <algorithm>
#include <cmath>

#include "benchmark/rig_readings.h"
#include "regression/grnn/kernel_mean.h"

namespace benchmark_data {

const std::vector<std::string> kSchemeNames = {"baseline", "method_1", "method_2", "method_3", "method_4"};

namespace {

using fsr::regression::CodeHistogram;
using fsr::regression::CodeStatistics;
using fsr::regression::FixedPressure;

// The readings of one section of a model: sums by code, and the range of the pressures.
struct Part {
  CodeStatistics sums;
  double lowest = INFINITY, highest = -INFINITY;  // [Pa]
};

// Every `stride`-th reading.
Part partOf(const fsr::regression::CodeSamples& cell, std::size_t stride) {
  fsr::regression::CodeAccumulator accumulator(kFullScale);
  Part part;
  for (std::size_t i = 0; i < cell.size(); i += stride) {
    accumulator.add(cell.code[i], cell.pressure[i]);
    part.lowest = std::min(part.lowest, fsr::regression::fromFixed(cell.pressure[i]));
    part.highest = std::max(part.highest, fsr::regression::fromFixed(cell.pressure[i]));
  }
  part.sums = accumulator.take();
  return part;
}

// A group of conditions that share one value of the second input of a model.
struct Group {
  double input;
  std::vector<Part> sections;  // all conditions of the group together
};

Group groupOf(const std::vector<fsr::regression::CodeSamples>& cells, double input, std::size_t first,
              std::size_t last, std::size_t stride) {
  Group group{input, std::vector<Part>(kSections)};
  for (std::size_t condition = first; condition < last; ++condition) {
    for (std::size_t section = 0; section < kSections; ++section) {
      const Part part = partOf(cells[condition * kSections + section], stride);
      Part& whole = group.sections[section];
      whole.sums.merge(part.sums);
      whole.lowest = std::min(whole.lowest, part.lowest);
      whole.highest = std::max(whole.highest, part.highest);
    }
  }
  return group;
}

// Models of a scheme, each a list of groups.
std::vector<std::vector<Group>> modelsOf(std::size_t scheme,
                                         const std::vector<fsr::regression::CodeSamples>& cells) {
  std::vector<std::vector<Group>> models;
  switch (scheme) {
    case 0:
      return {{groupOf(cells, 0, 0, kConditions, 6)}};
    case 1:
      for (std::size_t k = 0; k < kConditions; ++k) models.push_back({groupOf(cells, 0, k, k + 1, 1)});
      return models;
    case 2:
      models.resize(1);
      for (std::size_t k = 0; k < kConditions; ++k)
        models[0].push_back(groupOf(cells, kCurvature[k], k, k + 1, 6));
      return models;
    case 3:
      return {{groupOf(cells, 0, 0, 1, 1)}, {groupOf(cells, 0, 1, kConditions, 5)}};
    default:
      return {{groupOf(cells, 0, 0, 1, 1), groupOf(cells, 1, 1, kConditions, 5)}};
  }
}

// Sample deviation of the groups' inputs over the readings; 0 for one group.
double inputDeviation(const std::vector<Group>& groups, const std::vector<CodeHistogram>& training) {
  double number = 0, mean = 0, squares = 0;
  for (const CodeHistogram& histogram : training) number += static_cast<double>(histogram.samples());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    mean += groups[g].input * static_cast<double>(training[g].samples()) / number;
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    squares += static_cast<double>(training[g].samples()) * std::pow(groups[g].input - mean, 2);
  }
  return groups.size() > 1 ? std::sqrt(squares / (number - 1)) : 0.0;
}

// A model without one section.
class FoldModel {
 public:
  FoldModel(const std::vector<Group>& groups, std::size_t held_out) : groups_(groups), held_out_(held_out) {
    CodeHistogram all(kFullScale);
    std::vector<CodeHistogram> training;
    for (const Group& group : groups) {
      training.emplace_back(kFullScale);
      for (std::size_t section = 0; section < kSections; ++section) {
        if (section == held_out) continue;
        training.back().add(group.sections[section].sums);
        all.add(group.sections[section].sums);
      }
      samples_.push_back(fsr::regression::weightedCodes(training.back()));
    }
    deviation_ = fsr::regression::readingDeviation(all);
    input_deviation_ = inputDeviation(groups, training);
  }

  double rmsePercent(double bandwidth) const {
    const auto log_weight =
        groups_.size() > 1 ? fsr::regression::LogWeight::kYes : fsr::regression::LogWeight::kNo;
    std::vector<fsr::regression::KernelMean> means;
    for (const auto& samples : samples_) {
      means.push_back(fsr::regression::gaussianMean(samples, bandwidth * deviation_, log_weight));
    }
    double squares = 0, number = 0, lowest = INFINITY, highest = -INFINITY;
    for (const Group& group : groups_) {
      const Part& part = group.sections[held_out_];
      squares += squaredErrors(part.sums, means, inputExponents(group.input, bandwidth));
      number += static_cast<double>(part.sums.samples());
      lowest = std::min(lowest, part.lowest);
      highest = std::max(highest, part.highest);
    }
    return 100 * std::sqrt(squares / number) / (highest - lowest);
  }

 private:
  // For each group, the logarithm of the kernel value of its input.
  std::vector<double> inputExponents(double input, double bandwidth) const {
    std::vector<double> exponents;
    for (const Group& group : groups_) {
      const double d = groups_.size() > 1 ? (group.input - input) / input_deviation_ / bandwidth : 0.0;
      exponents.push_back(-0.5 * d * d);
    }
    return exponents;
  }

  static double answer(const std::vector<fsr::regression::KernelMean>& means,
                       const std::vector<double>& exponents, std::size_t code) {
    if (means.size() == 1) return means[0].pressure[code];
    double largest = -INFINITY, sum = 0, weights = 0;
    for (std::size_t g = 0; g < means.size(); ++g) {
      largest = std::max(largest, exponents[g] + means[g].log_weight[code]);
    }
    for (std::size_t g = 0; g < means.size(); ++g) {
      const double exponent = exponents[g] + means[g].log_weight[code] - largest;
      if (exponent < -40) continue;
      const double weight = std::exp(exponent);
      sum += weight * means[g].pressure[code];
      weights += weight;
    }
    return sum / weights;
  }

  static double squaredErrors(const CodeStatistics& sums,
                              const std::vector<fsr::regression::KernelMean>& means,
                              const std::vector<double>& exponents) {
    double squares = 0;
    sums.forEach([&](const fsr::regression::CodeSums& s) {
      // sum of (p - f)^2 about the mean of the code: exact in integers, except for the rounding of the mean
      const auto mean = static_cast<FixedPressure>(s.sum / s.count);
      const fsr::regression::Int128 scatter =
          s.sum_of_squares - fsr::regression::Int128{mean} * (2 * fsr::regression::Int128{s.sum} -
                                                              fsr::regression::Int128{mean} * s.count);
      const double error = answer(means, exponents, s.code) - fsr::regression::fromFixed(mean);
      const double rest = fsr::regression::fromFixed(s.sum - mean * s.count);
      squares += static_cast<double>(scatter) * fsr::regression::kFixedPressureUnit *
                     fsr::regression::kFixedPressureUnit +
                 error * (s.count * error - 2 * rest);
    });
    return squares;
  }

  const std::vector<Group>& groups_;
  std::size_t held_out_;
  std::vector<fsr::regression::WeightedCodes> samples_;  // for each group
  double deviation_ = 0, input_deviation_ = 0;
};

}  // namespace

std::vector<double> grnnStudy(const std::vector<fsr::regression::CodeSamples>& cells,
                              const std::vector<double>& bandwidths) {
  std::vector<double> rmse(kSchemes * bandwidths.size(), 0.0);
  for (std::size_t scheme = 0; scheme < kSchemes; ++scheme) {
    const auto models = modelsOf(scheme, cells);
    for (const std::vector<Group>& groups : models) {
      for (std::size_t section = 0; section < kSections; ++section) {
        const FoldModel model(groups, section);
        for (std::size_t b = 0; b < bandwidths.size(); ++b) {
          rmse[scheme * bandwidths.size() + b] +=
              model.rmsePercent(bandwidths[b]) / static_cast<double>(kSections * models.size());
        }
      }
    }
  }
  return rmse;
}

}  // namespace benchmark_data
