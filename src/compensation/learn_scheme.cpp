#include "fsr_pressure_map/compensation/learn_scheme.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/compensation/held_out_squares.h"
#include "fsr_pressure_map/compensation/kernel_blend.h"
#include "fsr_pressure_map/matrix/for_each_taxel.h"
#include "fsr_pressure_map/regression/weighted_codes.h"

namespace fsr {

namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// [taxels x values] summed over taxels, always in their order.
std::vector<double> sumOverTaxels(const std::vector<std::vector<double>>& of_taxel) {
  std::vector<double> sums(of_taxel.front().size(), 0.0);
  for (const std::vector<double>& values : of_taxel) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
  }
  return sums;
}

// ---- scaled_curvature -----------------------------------------------------------------------------------

std::vector<double> scaleGrid(const std::vector<CurvatureClass>& classes) {
  double low = INFINITY, high = -INFINITY;
  for (const CurvatureClass& one : classes) {
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

// Errors of every scale on one taxel.
class ScaleErrors {
 public:
  ScaleErrors(const TrainingStatistics& statistics, std::size_t taxel, const GrnnOptions& grnn,
              const std::vector<double>& grid)
      : statistics_(statistics), taxel_(taxel), grnn_(grnn), grid_(grid) {
    for (const CurvatureClass& one : statistics.classes) curvature_.push_back(one.at(taxel));
  }

  /// Mean squared errors on held-out sections [scales], then those on left-out inner classes [scales].
  std::vector<double> measure() const {
    std::vector<double> seen(grid_.size(), 0.0), unseen(grid_.size(), 0.0);
    double seen_readings = 0, unseen_readings = 0;
    for (std::size_t section = 0; section < statistics_.sections; ++section) {
      const std::vector<KernelMean> means = kernels(section);
      if (means.empty()) continue;
      for (std::size_t k = 0; k < curvature_.size(); ++k) {
        seen_readings += add(means, k, kNone, statistics_.cell(taxel_, k, section), seen);
      }
    }
    const std::vector<KernelMean> means = kernels(kNone);
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

  // Of each class, without a section; empty where a class would have no reading.
  std::vector<KernelMean> kernels(std::size_t left_out) const {
    std::vector<CodeHistogram> sums;
    CodeHistogram all(statistics_.full_scale);
    for (std::size_t k = 0; k < curvature_.size(); ++k) {
      sums.emplace_back(statistics_.full_scale);
      for (std::size_t section = 0; section < statistics_.sections; ++section) {
        if (section != left_out) sums.back().add(statistics_.cell(taxel_, k, section));
      }
      if (sums.back().samples() == 0) return {};
      all.add(sums.back());
    }
    std::vector<KernelMean> means;
    const double sigma = sigmaOf(grnn_) * readingDeviation(all);
    for (const CodeHistogram& of_class : sums) {
      means.push_back(gaussianMean(weightedCodes(of_class), sigma, LogWeight::kWhereZero));
    }
    return means;
  }

  // Adds the squares of every scale on readings of class k; returns their number.
  double add(const std::vector<KernelMean>& means, std::size_t k, std::size_t left_out,
             const CodeStatistics& readings, std::vector<double>& squares) const {
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      std::vector<double> exponent;
      for (std::size_t c = 0; c < means.size(); ++c) {
        const double away = (curvature_[k] - curvature_[c]) / grid_[i];
        exponent.push_back(c == left_out ? INFINITY : 0.5 * away * away);
      }
      squares[i] += squaredErrors(readings, blendKernels(means, exponent).pressure);
    }
    return static_cast<double>(readings.samples());
  }

  const TrainingStatistics& statistics_;
  std::size_t taxel_;
  const GrnnOptions& grnn_;
  const std::vector<double>& grid_;
  std::vector<double> curvature_;
};

double learnScale(const TrainingStatistics& statistics, const GrnnOptions& grnn,
                  const std::vector<std::size_t>& taxels, unsigned threads) {
  const std::vector<double> grid = scaleGrid(statistics.classes);
  if (!(grid.back() > 0)) return 0.0;  // one curvature: nothing to scale
  std::vector<std::vector<double>> of_taxel(taxels.size());
  forEachTaxel(taxels.size(), threads, [&](std::size_t i) {
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

// ---- curvature_ranges -----------------------------------------------------------------------------------

using Range = std::vector<std::size_t>;

// Squared errors of one model of the classes of `range` on the sections that it was trained without.
double rangeSquares(const TrainingStatistics& statistics, std::size_t taxel, const Grnn& grnn,
                    const Range& range) {
  CodeHistogram training(statistics.full_scale);
  const auto forEachCell = [&](std::size_t section, const auto& use) {
    for (const std::size_t k : range) use(statistics.cell(taxel, k, section));
  };
  for (std::size_t s = 0; s < statistics.sections; ++s) {
    forEachCell(s, [&](const CodeStatistics& cell) { training.add(cell); });
  }
  double squares = 0;
  for (std::size_t s = 0; s < statistics.sections; ++s) {
    forEachCell(s, [&](const CodeStatistics& cell) { training.subtract(cell); });
    if (training.samples() > 0) {
      const std::vector<double> pressure = grnn.fit(training).pressure;
      forEachCell(s, [&](const CodeStatistics& cell) { squares += squaredErrors(cell, pressure); });
    }
    forEachCell(s, [&](const CodeStatistics& cell) { training.add(cell); });
  }
  return squares;
}

// Summed over taxels, of several ranges at once.
std::vector<double> squaresOf(const std::vector<Range>& ranges, const TrainingStatistics& statistics,
                              const Grnn& grnn, const std::vector<std::size_t>& taxels, unsigned threads) {
  std::vector<std::vector<double>> of_taxel(taxels.size());
  forEachTaxel(taxels.size(), threads, [&](std::size_t i) {
    for (const Range& range : ranges) of_taxel[i].push_back(rangeSquares(statistics, taxels[i], grnn, range));
  });
  return sumOverTaxels(of_taxel);
}

Range joined(const Range& a, const Range& b) {
  Range both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

std::vector<Range> learnRanges(const TrainingStatistics& statistics, const Grnn& grnn,
                               const std::vector<std::size_t>& taxels, unsigned threads) {
  std::vector<Range> ranges;
  for (std::size_t k = 0; k < statistics.classes.size(); ++k) ranges.push_back({k});
  std::vector<double> alone = squaresOf(ranges, statistics, grnn, taxels, threads);
  while (ranges.size() > 1) {
    std::vector<Range> pairs;
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

}  // namespace

void learnScheme(const TrainingStatistics& statistics, const GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan) {
  if (plan.scheme == Scheme::kScaledCurvature) {
    plan.curvature_scale = learnScale(statistics, grnn, taxels, threads);
  }
  if (plan.scheme == Scheme::kCurvatureRanges) {
    planRanges(learnRanges(statistics, Grnn(grnn), taxels, threads), plan);
  }
}

}  // namespace fsr
