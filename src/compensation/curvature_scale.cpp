#include "compensation/curvature_scale.h"

#include <algorithm>
#include <cmath>

#include "compensation/held_out_squares.h"
#include "matrix/for_each_taxel.h"
#include "regression/grnn/weighted_codes.h"
#include "regression/kernel_blend.h"

namespace fsr::compensation {

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

}  // namespace fsr::compensation
