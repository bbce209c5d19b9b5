#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "statistics/bootstrap.h"
#include "statistics/samples.h"

namespace fsr::statistics {

namespace {

double phi(double z) {
  return boost::math::cdf(boost::math::normal(), z);
}

double phiInverse(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

double biasCorrection(double estimate, const std::vector<double>& sorted) {
  const auto range = std::equal_range(sorted.begin(), sorted.end(), estimate);
  const double below = static_cast<double>(range.first - sorted.begin());
  const double equal = static_cast<double>(range.second - range.first);
  const double size = static_cast<double>(sorted.size());
  return phiInverse(std::clamp((below + 0.5 * equal) / size, 0.5 / size, 1 - 0.5 / size));
}

double acceleration(const std::vector<double>& jackknife) {
  const double mean = meanOf(jackknife);
  double squares = 0, cubes = 0;
  for (const double value : jackknife) {
    const double influence = mean - value;
    squares += influence * influence;
    cubes += influence * influence * influence;
  }
  return squares > 0 ? cubes / (6 * std::pow(squares, 1.5)) : 0;
}

/// Davison and Hinkley's quantile: linear in the normal deviate between order statistics.
double normalScaleQuantile(const std::vector<double>& sorted, double p) {
  const double places = static_cast<double>(sorted.size()) + 1, position = places * p;
  if (position <= 1) return sorted.front();
  if (position >= places - 1) return sorted.back();
  const double k = std::floor(position);
  const double low = sorted[static_cast<std::size_t>(k) - 1], high = sorted[static_cast<std::size_t>(k)];
  const double from = phiInverse(k / places), to = phiInverse((k + 1) / places);
  return low + (phiInverse(p) - from) / (to - from) * (high - low);
}

}  // namespace

Interval bcaInterval(double estimate, std::vector<double> replicates, const std::vector<double>& jackknife,
                     double confidence) {
  std::sort(replicates.begin(), replicates.end());
  const double z0 = biasCorrection(estimate, replicates), a = acceleration(jackknife);
  const auto limit = [&](double z) {
    const double shifted = z0 + z, divisor = 1 - a * shifted;
    // Beyond the pole the correction has no meaning. As |a| <= 1 / 6, only a very large z0 reaches it.
    if (divisor <= 0) return shifted < 0 ? replicates.front() : replicates.back();
    return normalScaleQuantile(replicates, phi(z0 + shifted / divisor));
  };
  const double z = phiInverse(0.5 * (1 + confidence));
  return {limit(-z), limit(z)};
}

}  // namespace fsr::statistics
