#include "discrepancy/fit/cycle_scatter.h"

#include <array>
#include <cmath>

#include "statistics/median.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kFewestCycles = 3;
constexpr double kNormal95 = 1.96;      // of a normal distribution: 95 % lie within
constexpr double kSeen = 0.5;           // relative standard error of a variance that can be told from 0
constexpr double kTellingSlope = 0.05;  // of the usual one: below it a reading tells nothing of the pressure

constexpr std::size_t kAll = CycleNoise::kParts;
using Parts = Eigen::Matrix<double, static_cast<int>(kAll), 1>;
using Square = Eigen::Matrix<double, static_cast<int>(kAll), static_cast<int>(kAll)>;

// ScatterSums over all bins of the variance that each part has at variance 1.
struct ScatterSums {
  Square information = Square::Zero();
  Parts reading = Parts::Zero();   // [share of full scale, squared]
  Parts pressure = Parts::Zero();  // [Pa^2]
  double scans = 0, scans_with_slope = 0;
};

double leastSlope(const CycleDesign& design) {
  std::vector<double> slopes;
  for (const CycleBins& bins : design.cycles) {
    for (Eigen::Index b = 0; b < bins.bins(); ++b) slopes.push_back(bins.slope[b]);
  }
  return kTellingSlope * statistics::upperMedian(slopes, 0);
}

void add(const CycleBins& bins, const std::array<Eigen::MatrixXd, kAll>& parts, double least,
         ScatterSums& sums) {
  for (Eigen::Index b = 0; b < bins.bins(); ++b) {
    const bool slope = bins.slope[b] >= least && bins.slope[b] > 0;
    sums.scans += bins.scans[b];
    if (slope) sums.scans_with_slope += bins.scans[b];
    for (std::size_t k = 0; k < kAll; ++k) {
      const double variance = bins.scans[b] * parts[k](b, b);
      const auto at = static_cast<Eigen::Index>(k);
      sums.reading[at] += variance;
      if (slope) sums.pressure[at] += variance / (bins.slope[b] * bins.slope[b]);
    }
  }
}

// I_kl = tr(S^-1 V_k S^-1 V_l) / 2, added up over the cycles.
ScatterSums sumsOf(const CycleDesign& design, const CycleNoise& noise) {
  ScatterSums sums;
  const double least = leastSlope(design);
  for (const CycleBins& bins : design.cycles) {
    const auto parts = CycleNoise::parts(bins, design.cycle_time);
    const Eigen::LLT<Eigen::MatrixXd> root(noise.covariance(bins, design.cycle_time));
    std::array<Eigen::MatrixXd, kAll> solved;
    for (std::size_t k = 0; k < kAll; ++k) solved[k] = root.solve(parts[k]);
    for (std::size_t k = 0; k < kAll; ++k) {
      for (std::size_t l = 0; l < kAll; ++l)
        sums.information(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) +=
            0.5 * solved[k].cwiseProduct(solved[l].transpose()).sum();
    }
    add(bins, parts, least, sums);
  }
  return sums;
}

// Covariance of the variances. Their units differ by many orders, so the information is scaled first. A part
// that these cycles do not have (no corners, say) has no information and is left out.
Square covarianceOf(const Square& information) {
  Parts scale = Parts::Zero();
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    if (information(k, k) > 0) scale[k] = 1 / std::sqrt(information(k, k));
  }
  Square scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

Interval intervalOf(double variance, double error) {
  if (!(variance > 0) || error > kSeen * variance) return {0, std::sqrt(variance + kNormal95 * error)};
  const double factor = std::exp(0.5 * kNormal95 * error / variance);
  return {std::sqrt(variance) / factor, std::sqrt(variance) * factor};
}

}  // namespace

std::vector<Scatter> scatterOf(const CycleDesign& design, const CycleNoise& noise) {
  if (design.cycles.size() < kFewestCycles) return {};
  const ScatterSums sums = sumsOf(design, noise);
  const Square covariance = covarianceOf(sums.information);
  Parts variance;
  for (std::size_t k = 0; k < kAll; ++k) variance[static_cast<Eigen::Index>(k)] = noise.variance[k];
  const double total = sums.reading.dot(variance);
  // `weight`: of each part's variance in the square of the size.
  const auto scatter = [&](const std::string& name, const std::string& unit, const Parts& weight) {
    Scatter one{name, unit, 0, {}, 0, 0};
    const double square = weight.dot(variance);
    one.size = std::sqrt(square);
    one.interval = intervalOf(square, std::sqrt(std::max(0.0, weight.dot(covariance * weight))));
    const Parts taken = (weight.array() != 0).select(variance, Parts::Zero());
    one.at_map = std::sqrt(sums.pressure.dot(taken) / std::max(1.0, sums.scans_with_slope));
    one.of_noise = total > 0 ? sums.reading.dot(taken) / total : 0;
    return one;
  };
  Parts wandering = Parts::Zero();
  for (const CycleNoise::Part part : {CycleNoise::kSlow, CycleNoise::kWanderingGain})
    wandering[part] = sums.reading[part] / sums.scans;
  return {scatter("cycle_gain", "share", Parts::Unit(CycleNoise::kCycleGain)),
          scatter("cycle_offset", "share of full scale", Parts::Unit(CycleNoise::kCycleOffset)),
          scatter("wandering", "share of full scale", wandering)};
}

}  // namespace fsr::discrepancy
