#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "discrepancy/fit/cycle_design.h"
#include "discrepancy/fit/cycle_noise.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy::drawn {

/// Where a bin lies.
struct Place {
  std::size_t cycle = 0;
  double share = 0;   ///< of the highest pressure, 0 .. 1
  double inside = 0;  ///< position in the cycle, 0 .. 1
  int direction = 1;  ///< +1 = loading, -1 = unloading
};
using Course = std::function<double(const Place&)>;

/// A design without recordings: cycles that rise and fall evenly. The cycles of two classes alternate.
struct Plan {
  std::size_t cycles = 24;
  Eigen::Index bins = 20;  ///< of each cycle
  std::size_t classes = 1;
  std::size_t knots = 14;
  std::vector<Course> columns = {};  ///< those before the column of the corners
};

constexpr double kHighest = 600e3;       // [Pa]
constexpr double kCycleTime = 40;        // [s]
constexpr double kFullReading = 0.6;     // static reading at the highest pressure [share of full scale]
constexpr double kWhiteVariance = 1e-8;  // of one bin [share of full scale, squared]

inline double straight(double share) {
  return 0.02 + (kFullReading - 0.02) * share;
}

/// The readings are those of the straight static curve.
inline CycleDesign design(const Plan& plan) {
  std::vector<double> knots;
  for (std::size_t k = 0; k < plan.knots; ++k)
    knots.push_back(kHighest * static_cast<double>(k) / static_cast<double>(plan.knots - 1));
  const SplineBasis basis(knots);
  CycleDesign design;
  design.classes = design.visits = plan.classes;
  design.splines = static_cast<Eigen::Index>(basis.size());
  design.corners = static_cast<Eigen::Index>(plan.columns.size());
  design.columns = design.corners + 1;
  design.range = kHighest;
  design.cycle_time = kCycleTime;
  for (std::size_t c = 0; c < plan.classes; ++c) {
    design.flat.push_back(c == 0);
    design.class_of.push_back(c);
    design.visited_again.push_back(false);
  }
  for (std::size_t c = 0; c < plan.cycles; ++c) {
    CycleBins bins;
    bins.cycle = c;
    bins.visit = bins.curvature_class = c % plan.classes;
    for (Eigen::VectorXd* v :
         {&bins.reading, &bins.net, &bins.slope, &bins.pressure, &bins.time, &bins.corner})
      v->setZero(plan.bins);
    bins.white.setConstant(plan.bins, kWhiteVariance);
    bins.scans.setConstant(plan.bins, 10);
    bins.splines.setZero(plan.bins, design.splines);
    bins.columns.setZero(plan.bins, design.columns);
    for (Eigen::Index b = 0; b < plan.bins; ++b) {
      Place place;
      place.cycle = c;
      place.inside = (static_cast<double>(b) + 0.5) / static_cast<double>(plan.bins);
      place.share = 1 - std::abs(2 * place.inside - 1);
      place.direction = place.inside < 0.5 ? 1 : -1;
      bins.pressure[b] = kHighest * place.share;
      bins.time[b] = kCycleTime * (static_cast<double>(c) + place.inside);
      bins.slope[b] = (kFullReading - 0.02) / kHighest;
      bins.net[b] = straight(place.share) - 0.02;
      bins.reading[b] = straight(place.share);
      const SplineBasis::Values at = basis.at(bins.pressure[b]);
      for (std::size_t k = 0; k < SplineBasis::kAtOnce; ++k)
        bins.splines(b, static_cast<Eigen::Index>(at.first + k)) = at.value[k];
      for (std::size_t k = 0; k < plan.columns.size(); ++k)
        bins.columns(b, static_cast<Eigen::Index>(k)) = plan.columns[k](place);
    }
    design.cycles.push_back(bins);
  }
  return design;
}

/// Adds noise to the readings.
inline void addNoise(CycleDesign& design, const CycleNoise& noise, std::uint64_t seed) {
  for (std::size_t c = 0; c < design.cycles.size(); ++c) {
    CycleBins& bins = design.cycles[c];
    const statistics::RandomStream stream = statistics::randomStream(seed, "drawn design", c);
    Eigen::VectorXd z(bins.bins());
    for (Eigen::Index b = 0; b < z.size(); ++b) z[b] = stream.normal(static_cast<std::uint64_t>(b));
    const Eigen::LLT<Eigen::MatrixXd> root(noise.covariance(bins, design.cycle_time));
    bins.reading += root.matrixL() * z;
  }
}

/// Adds a column to the readings.
inline void addColumn(CycleDesign& design, Eigen::Index column, double coefficient) {
  for (CycleBins& bins : design.cycles) bins.reading += coefficient * bins.columns.col(column);
}

inline CycleNoise whiteNoise() {
  CycleNoise noise;
  noise.variance.fill(0);
  noise.variance[CycleNoise::kWhite] = 1;
  return noise;
}

/// White noise with these variances of a cycle's gain and of slow wandering.
inline CycleNoise wanderingNoise(double gain = 1e-6, double slow = 4e-8) {
  CycleNoise noise = whiteNoise();
  noise.variance[CycleNoise::kCycleGain] = gain;
  noise.variance[CycleNoise::kSlow] = slow;
  return noise;
}

// Columns: a loop, and one that changes its sign half-way.
inline double loop(const Place& at) {
  return at.direction * std::sin(M_PI * at.share);
}
inline double turning(const Place& at) {
  return at.direction * std::sin(2 * M_PI * at.share);
}

}  // namespace fsr::discrepancy::drawn
