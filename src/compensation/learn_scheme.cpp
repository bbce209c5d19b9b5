#include "compensation/learn_scheme.h"

#include <algorithm>
#include <cmath>

#include "matrix/for_each_taxel.h"
#include "regression/grnn/weighted_codes.h"
#include "regression/second_input.h"

namespace fsr::compensation {

double squaredErrors(const regression::CodeStatistics& readings, const std::vector<double>& pressure) {
  double squares = 0;
  readings.forEach([&](const regression::CodeSums& sums) {
    const double count = sums.count;
    const double mean = regression::fromFixed(sums.sum) / count;
    const regression::Int128 spread =
        sums.sum_of_squares * sums.count - regression::Int128{sums.sum} * sums.sum;
    const double error = pressure[sums.code] - mean;
    squares +=
        static_cast<double>(spread) / count * regression::kFixedPressureUnit * regression::kFixedPressureUnit;
    squares += count * error * error;
  });
  return squares;
}

std::vector<double> sumOverTaxels(const std::vector<std::vector<double>>& of_taxel) {
  std::vector<double> sums(of_taxel.front().size(), 0.0);
  for (const std::vector<double>& values : of_taxel) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
  }
  return sums;
}

namespace {

// Squared errors of one model of the classes of `range`, each on the section that it was trained without.
double rangeSquares(const TrainingStatistics& statistics, std::size_t taxel, const regression::Grnn& grnn,
                    const CurvatureRange& range) {
  regression::CodeHistogram training(statistics.full_scale);
  const auto forEachCell = [&](std::size_t section, const auto& use) {
    for (const std::size_t k : range) use(statistics.cell(taxel, k, section));
  };
  for (std::size_t s = 0; s < statistics.sections; ++s) {
    forEachCell(s, [&](const regression::CodeStatistics& cell) { training.add(cell); });
  }
  double squares = 0;
  for (std::size_t s = 0; s < statistics.sections; ++s) {
    forEachCell(s, [&](const regression::CodeStatistics& cell) { training.subtract(cell); });
    if (training.samples() > 0) {
      const std::vector<double> pressure = grnn.fit(training).pressure;
      forEachCell(s,
                  [&](const regression::CodeStatistics& cell) { squares += squaredErrors(cell, pressure); });
    }
    forEachCell(s, [&](const regression::CodeStatistics& cell) { training.add(cell); });
  }
  return squares;
}

// Errors of several ranges, summed over taxels.
std::vector<double> squaresOf(const std::vector<CurvatureRange>& ranges, const TrainingStatistics& statistics,
                              const regression::Grnn& grnn, const std::vector<std::size_t>& taxels,
                              unsigned threads) {
  std::vector<std::vector<double>> of_taxel(taxels.size());
  matrix::forEachTaxel(taxels.size(), threads, [&](std::size_t i) {
    for (const CurvatureRange& range : ranges)
      of_taxel[i].push_back(rangeSquares(statistics, taxels[i], grnn, range));
  });
  return sumOverTaxels(of_taxel);
}

CurvatureRange joined(const CurvatureRange& a, const CurvatureRange& b) {
  CurvatureRange both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

}  // namespace

std::vector<CurvatureRange> learnRanges(const TrainingStatistics& statistics, const regression::Grnn& grnn,
                                        const std::vector<std::size_t>& taxels, unsigned threads) {
  std::vector<CurvatureRange> ranges;
  for (std::size_t k = 0; k < statistics.classes.size(); ++k) ranges.push_back({k});
  std::vector<double> alone = squaresOf(ranges, statistics, grnn, taxels, threads);
  while (ranges.size() > 1) {
    std::vector<CurvatureRange> pairs;
    for (std::size_t i = 0; i + 1 < ranges.size(); ++i) pairs.push_back(joined(ranges[i], ranges[i + 1]));
    const std::vector<double> merged = squaresOf(pairs, statistics, grnn, taxels, threads);
    const auto cost = [&](std::size_t i) { return merged[i] / (alone[i] + alone[i + 1]); };
    std::size_t best = 0;
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      if (cost(i) < cost(best)) best = i;
    }
    if (!(cost(best) <= 1 + kMergeCost)) break;
    const auto at = static_cast<std::ptrdiff_t>(best);
    ranges[best] = pairs[best];
    alone[best] = merged[best];
    ranges.erase(ranges.begin() + at + 1);
    alone.erase(alone.begin() + at + 1);
  }
  return ranges;
}

namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::vector<double> scaleGrid(const std::vector<dataset::CurvatureClass>& classes) {
  double low = INFINITY, high = -INFINITY;
  for (const dataset::CurvatureClass& one : classes) {
    for (const double curvature : one.curvature) {
      low = std::min(low, curvature);
      high = std::max(high, curvature);
    }
  }
  std::vector<double> grid;
  for (int half_power = -12; half_power <= 2; ++half_power) {
    grid.push_back((high - low) * std::pow(2.0, 0.5 * half_power));
  }
  return grid;
}

// Errors of all scales on one taxel.
class ScaleErrors {
 public:
  ScaleErrors(const TrainingStatistics& statistics, std::size_t taxel, const regression::GrnnOptions& grnn,
              const std::vector<double>& grid)
      : statistics_(statistics), taxel_(taxel), grnn_(grnn), grid_(grid) {
    for (const dataset::CurvatureClass& one : statistics.classes) curvature_.push_back(one.at(taxel));
  }

  /// Mean squared errors on held-out sections [scales], then those on left-out inner classes [scales].
  std::vector<double> measure() const {
    std::vector<double> seen(grid_.size(), 0.0), unseen(grid_.size(), 0.0);
    double seen_readings = 0, unseen_readings = 0;
    for (std::size_t section = 0; section < statistics_.sections; ++section) {
      const std::vector<regression::KernelMean> means = kernels(section);
      if (means.empty()) continue;
      for (std::size_t k = 0; k < curvature_.size(); ++k) {
        seen_readings += add(means, k, kNone, statistics_.cell(taxel_, k, section), seen);
      }
    }
    const std::vector<regression::KernelMean> means = kernels(kNone);
    for (std::size_t k = 0; k < curvature_.size(); ++k) {
      if (!isInner(k)) continue;
      for (std::size_t section = 0; section < statistics_.sections; ++section) {
        unseen_readings += add(means, k, k, statistics_.cell(taxel_, k, section), unseen);
      }
    }
    for (double& squares : seen) squares /= std::max(seen_readings, 1.0);
    for (double& squares : unseen) squares /= std::max(unseen_readings, 1.0);
    seen.insert(seen.end(), unseen.begin(), unseen.end());
    return seen;
  }

 private:
  bool isInner(std::size_t k) const {
    const auto [low, high] = std::minmax_element(curvature_.begin(), curvature_.end());
    return curvature_[k] > *low && curvature_[k] < *high;
  }

  // Kernel means of each class, without a section; empty if a class would have no reading.
  std::vector<regression::KernelMean> kernels(std::size_t left_out) const {
    std::vector<regression::CodeHistogram> sums;
    regression::CodeHistogram all(statistics_.full_scale);
    for (std::size_t k = 0; k < curvature_.size(); ++k) {
      sums.emplace_back(statistics_.full_scale);
      for (std::size_t section = 0; section < statistics_.sections; ++section) {
        if (section != left_out) sums.back().add(statistics_.cell(taxel_, k, section));
      }
      if (sums.back().samples() == 0) return {};
      all.add(sums.back());
    }
    std::vector<regression::KernelMean> means;
    const double sigma = regression::sigmaOf(grnn_) * regression::readingDeviation(all);
    for (const regression::CodeHistogram& of_class : sums) {
      means.push_back(regression::gaussianMean(regression::weightedCodes(of_class), sigma,
                                               regression::LogWeight::kWhereZero));
    }
    return means;
  }

  // Adds the squared errors of all scales on readings of class k. Returns the number of readings.
  double add(const std::vector<regression::KernelMean>& means, std::size_t k, std::size_t left_out,
             const regression::CodeStatistics& readings, std::vector<double>& squares) const {
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      std::vector<double> exponent;
      for (std::size_t c = 0; c < means.size(); ++c) {
        const double away = (curvature_[k] - curvature_[c]) / grid_[i];
        exponent.push_back(c == left_out ? INFINITY : 0.5 * away * away);
      }
      squares[i] += squaredErrors(readings, regression::blendKernels(means, exponent).pressure);
    }
    return static_cast<double>(readings.samples());
  }

  const TrainingStatistics& statistics_;
  std::size_t taxel_;
  const regression::GrnnOptions& grnn_;
  const std::vector<double>& grid_;
  std::vector<double> curvature_;
};

}  // namespace

double learnScale(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                  const std::vector<std::size_t>& taxels, unsigned threads) {
  const std::vector<double> grid = scaleGrid(statistics.classes);
  if (!(grid.back() > 0)) return 0.0;  // only one curvature
  std::vector<std::vector<double>> of_taxel(taxels.size());
  matrix::forEachTaxel(taxels.size(), threads, [&](std::size_t i) {
    of_taxel[i] = ScaleErrors(statistics, taxels[i], grnn, grid).measure();
  });
  const std::vector<double> errors = sumOverTaxels(of_taxel);
  std::size_t best = 0;
  const bool any_unseen = errors[grid.size()] > 0;
  const auto cost = [&](std::size_t i) { return errors[i] * (any_unseen ? errors[grid.size() + i] : 1.0); };
  for (std::size_t i = 1; i < grid.size(); ++i) {
    if (cost(i) < cost(best)) best = i;
  }
  return grid[best];
}

void learnScheme(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan) {
  if (plan.scheme == Scheme::kScaledCurvature) {
    plan.curvature_scale = learnScale(statistics, grnn, taxels, threads);
  }
  if (plan.scheme == Scheme::kCurvatureRanges) {
    planRanges(learnRanges(statistics, regression::Grnn(grnn), taxels, threads), plan);
  }
}

}  // namespace fsr::compensation
