#pragma once

#include <vector>

#include "regression/regressor.h"

namespace fsr::regression {

/// A sensor's curve, reading over pressure, which never turns back.
///
/// The other regressors answer with the mean pressure of the training scans that gave a reading. Where
/// readings scatter, that mean leans towards pressures which the chamber held long: a prior from its time
/// profile, which no other use shares. The reading at a known pressure carries no such prior. So:
///
/// 1. readings are averaged in bins of the known pressure (see pressure_grid.h, up to kCurveBins);
/// 2. the means are made monotone by isotonic regression, each weighing as its number of readings;
/// 3. each pooled block is a knot at its mean pressure and mean reading, and straight lines join the
///    knots: strictly monotone, so that the inverse exists everywhere between them;
/// 4. beyond the outer knots the curve goes on with the slope of the outermost sixteenth of the readings,
///    as far as the pressures of training reach, and stays there.
///
/// Readings that rise and readings that fall with pressure are both welcome; the sign of their covariance
/// decides. Where all readings or all pressures agree there is one knot, and its pressure is the answer.
class MonotoneCurve {
 public:
  /// `training` holds at least one sample. Throws InputError as validate(CodeSamples) does.
  explicit MonotoneCurve(const CodeSamples& training);

  /// Pressure of a reading [Pa], within the pressures of training.
  double pressureAt(double reading) const;

  /// Deviation of that pressure [Pa] by propagation: the readings' scatter about the curve at that
  /// pressure [counts], times the curve's slope over one scatter to either side [Pa a count]. The scatter
  /// of a knot is drawn towards that of all as if it had thirty readings more.
  double deviationAt(double reading) const;

  /// Number of readings behind the answer: 1 / (variance of the interpolated mean), in units of the
  /// variance of one reading.
  double supportAt(double reading) const;

  /// Knots by ascending reading.
  const std::vector<double>& knotReading() const { return reading_; }    ///< [counts]
  const std::vector<double>& knotPressure() const { return pressure_; }  ///< [Pa], strictly monotone

 private:
  struct Place;
  Place placeOf(double reading) const;
  void measureScatter(const CodeSamples& training);
  double outerSlope(bool low_end) const;
  double readingAt(double pressure) const;
  double scatterAt(double reading) const;

  std::vector<double> reading_, pressure_, readings_, scatter_;  // of each knot
  double slope_below_ = 0, slope_above_ = 0;                     // beyond the outer knots [Pa a count]
  double lowest_ = 0, highest_ = 0;                              // pressures of training [Pa]
};

constexpr std::size_t kCurveBins = 128;

/// The inverted curve as a regressor. It needs each reading's pressure: not mergeable.
class Monotone : public Regressor {
 public:
  std::string name() const override { return "monotone"; }
  bool mergeable() const override { return false; }
  Fit fit(const CodeHistogram& training) const override;
  Fit fitSamples(const CodeSamples& training) const override;
};

}  // namespace fsr::regression
