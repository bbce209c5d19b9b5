#pragma once

#include <cstddef>
#include <vector>

#include "blind/campaign.h"
#include "blind/hidden.h"

namespace blind {

/// Non-decreasing values nearest to `values` by weighted least squares (pool adjacent violators).
std::vector<double> isotonic(const std::vector<double>& values, const std::vector<double>& weights);

/// What remains of a hidden effect after the best static description of the sheet has been subtracted. This
/// is the generator's measure of an effect's size, on readings without noise.
///
/// Pressures are pooled into bins that are too wide for a curve to follow single scans. The curve is fitted
/// to the means of the bins and is linear between them. The reading without the effect is subtracted scan by
/// scan, so that the sheet's own slope within a bin does not count as an effect.
class StaticFit {
 public:
  explicit StaticFit(const Campaign& campaign, double bin = kCurveBin);

  /// Residual of one taxel at each scan after a fit of one monotone curve for each surface.
  Trace residualOfCurves(const Trace& base, const Trace& reading) const;

  /// The same after a fit of one monotone curve, with a gain and a preload for each surface except the first.
  /// `zero` is the reading without load. For effects that are static themselves: everything that is not a
  /// function of pressure and surface counts as residual.
  Trace residualOfSharedCurve(const Trace& base, const Trace& reading, double zero) const;

  static constexpr double kCurveBin = 20e3;  ///< [Pa]
  static constexpr double kSharedBin = 2e3;  ///< for a shared curve, which many bins determine [Pa]

 private:
  struct BinMeans {
    std::vector<double> base, reading, pressure, weight;  // means of the bins, [surface x bin]
  };
  std::size_t cell(std::size_t surface, std::size_t bin) const { return surface * bins_ + bin; }
  BinMeans means(const Trace& base, const Trace& reading) const;
  // `fit`: value of the static curve in each cell that has scans.
  Trace subtract(const Trace& base, const Trace& reading, const BinMeans& means,
                 const std::vector<double>& fit) const;

  const Campaign& campaign_;
  std::size_t bins_;
  std::vector<std::size_t> cell_;  // cell of each scan
};

}  // namespace blind
