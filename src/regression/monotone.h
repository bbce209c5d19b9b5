#pragma once

#include <cstddef>
#include <vector>

#include "regression/regressor.h"

namespace fsr::regression {

/// A run of neighbouring points with the same value in an isotonic regression.
struct IsotonicBlock {
  std::size_t begin = 0;  ///< points begin .. end - 1
  std::size_t end = 0;
  double level = 0;   ///< weighted mean of the points
  double weight = 0;  ///< sum of the weights
};

/// The non-decreasing sequence with the least weighted sum of squares through `values`, by pooling adjacent
/// violators (Ayer et al., Annals of Mathematical Statistics 26 (1955) 641-647). Levels of the blocks
/// increase strictly. One positive weight for each value.
std::vector<IsotonicBlock> isotonicRegression(const std::vector<double>& values,
                                              const std::vector<double>& weights);

/// A sensor's curve, reading over pressure, as a strictly monotone function.
///
/// The other regressors answer with the mean pressure of the training scans that have a reading. Where
/// readings scatter, that mean is biased towards pressures that the chamber held long, i.e. by the time
/// profile of the training. The mean reading at a known pressure has no such bias. Therefore:
///
/// 1. readings are averaged in bins of the known pressure (see pressure_grid.h, up to kCurveBins);
/// 2. the means are made monotone by isotonic regression, weighted by the number of readings;
/// 3. each pooled block is a knot at its mean pressure and mean reading; straight lines join the knots, so
///    the curve is strictly monotone and has an inverse between the outer knots;
/// 4. beyond the outer knots the curve continues with the slope of the outermost sixteenth of the readings up
///    to the range of training pressures, and is constant there.
///
/// Readings may increase or decrease with pressure; the sign of their covariance decides. If all readings or
/// all pressures are equal, there is one knot, and its pressure is the answer.
class MonotoneCurve {
 public:
  /// `training` has at least one sample. Throws InputError as validate(CodeSamples) does.
  explicit MonotoneCurve(const CodeSamples& training);

  /// Pressure of a reading [Pa], within the training pressures.
  double pressureAt(double reading) const;

  /// Effective number of readings: 1 / (variance of the interpolated mean), in units of the variance of one
  /// reading.
  double supportAt(double reading) const;

  /// Knots by ascending reading.
  const std::vector<double>& knotReading() const { return reading_; }    ///< [counts]
  const std::vector<double>& knotPressure() const { return pressure_; }  ///< [Pa], strictly monotone

 private:
  struct Place;
  Place placeOf(double reading) const;
  double outerSlope(bool low_end) const;

  std::vector<double> reading_, pressure_, readings_;  // of each knot
  double slope_below_ = 0, slope_above_ = 0;           // beyond the outer knots [Pa a count]
  double lowest_ = 0, highest_ = 0;                    // pressures of training [Pa]
};

constexpr std::size_t kCurveBins = 128;

/// The inverted curve as a regressor. It needs the pressure of each reading, so it is not mergeable.
class Monotone : public Regressor {
 public:
  std::string name() const override { return "monotone"; }
  bool mergeable() const override { return false; }
  Fit fit(const CodeHistogram& training) const override;
  Fit fitSamples(const CodeSamples& training) const override;
};

}  // namespace fsr::regression
