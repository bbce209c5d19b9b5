#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::calibration {

/// How the covariance of two taxels decreases with their distance d; l is the length.
enum class FieldFamily {
  kMatern,   ///< (1 + a) exp(-a), a = sqrt(3) d / l: a rough field
  kGaussian  ///< exp(-(d / l)^2 / 2): a smooth field
};

/// What a new mount on the same surface changes at rest: a random field over the sheet with the covariance
/// deviation^2 r(d / length) + common^2, and white^2 for each taxel alone. The load before adds a pattern of
/// unknown strength.
struct MountScatter {
  FieldFamily family = FieldFamily::kMatern;
  double deviation = 0;       ///< [Pa]
  double length = 0;          ///< [m]
  double common = 0;          ///< of all taxels alike [Pa]
  double white = 0;           ///< [Pa]
  double history = 0;         ///< what the load before leaves behind, mean over the taxels [Pa]
  std::size_t contrasts = 0;  ///< differences between mounts of one surface that it was learnt from
};

/// How much the reading at rest changes between curvatures k, beside the means that were measured:
///
///     of the mean over the taxels   common^2 r(|w(k) - w(k')| / common_length), w(k) = log(1 + |k| 0.1 m)
///     of each taxel beside it       own_offset^2 + own_share^2 m(k) m(k') + own^2 r(|k - k'| / own_length)
///
/// and own_white^2 for each surface and taxel alone. r: as FieldFamily::kMatern. m: the mean over the taxels.
struct ShapeLaw {
  double common = 0;         ///< [Pa]
  double common_length = 0;  ///< of w
  double own_offset = 0;     ///< [Pa]
  double own_share = 0;
  double own = 0;         ///< [Pa]
  double own_length = 0;  ///< [1/m]
  double own_white = 0;   ///< [Pa]
};

/// What the unloaded sheet reads on surfaces of known curvature, from which its bend can be told.
/// A reading is divided by the sensitivity of its taxel, so that a mount that presses harder moves all taxels
/// alike.
struct ShapeModel {
  /// A sentence: why there is no model; empty = there is one.
  std::string missing = "none was learnt";
  matrix::Layout layout;
  std::uint16_t full_scale = 0;
  std::vector<std::uint8_t> used;  ///< [taxels], 1 = takes part
  /// [taxels], pressure that a reading stands for: scale times its share of the full scale [Pa].
  std::vector<double> scale;
  std::vector<std::string> surfaces;        ///< names, by ascending curvature
  std::vector<double> curvature;            ///< principal, [surfaces] [1/m]
  std::vector<std::uint32_t> mounts;        ///< [surfaces], number of mounts behind the means
  std::vector<double> gain;                 ///< [surfaces], how strongly a mount acts there
  std::vector<double> zero_share;           ///< [surfaces], share of the readings at rest that are 0
  std::vector<double> rest;                 ///< means over mounts [surfaces x taxels] [Pa]
  matrix::Curvature direction = {1, 0, 0};  ///< of the bend, for a principal curvature of 1
  bool one_direction = true;                ///< all surfaces are bent in this direction
  MountScatter scatter;
  std::vector<double> history;  ///< pattern that a load leaves behind, [taxels], mean 1; empty = all alike
  ShapeLaw law;
  /// [surfaces - 1] error to expect of an estimate between two neighbours: that on the surfaces at its ends,
  /// each estimated without itself [1/m]; NaN = not known.
  std::vector<double> error_between;

  bool present() const { return missing.empty(); }
};

/// Readings at rest: mean over some seconds of each taxel.
struct RestReading {
  std::vector<double> reading;     ///< [taxels], counts; NaN = no reading
  std::vector<std::uint8_t> zero;  ///< [taxels], 1 = the converter's lower end cuts the reading
};

/// What the readings at rest say of the curvature of the sheet.
struct ShapeEstimate {
  double curvature = 0;  ///< principal [1/m]
  double deviation = 0;  ///< [1/m]
  double low = 0;        ///< 95 % interval [1/m]
  double high = 0;
  double fit = 0;          ///< probability of a fit as bad as this or worse, at the best curvature
  double best = 0;         ///< the most likely curvature [1/m]
  bool beyond = false;     ///< the whole interval is outside of the training
  bool between = false;    ///< it is between trained surfaces
  double likelihood = 0;   ///< logarithm at the best curvature, up to a constant
  std::size_t taxels = 0;  ///< number of taxels that took part
};

/// How much the curvature changes along the sheet, between its outermost taxels.
struct BendChange {
  double change = 0;     ///< principal, last column or row minus first [1/m]
  double deviation = 0;  ///< [1/m]; infinite = not at a maximum of the likelihood
  double low = 0;        ///< 95 % interval [1/m]
  double high = 0;
};

/// A bend that changes linearly along the sheet, as on a cone. See tellBendChange().
struct ChangingBend {
  double centre = 0;              ///< principal curvature in the middle of the sheet [1/m]
  BendChange along_x, along_y;    ///< along a row, along a column
  double probability = 1;         ///< that a constant bend looks as changing as this or more
  double likelihood = 0;          ///< logarithm, up to the constant of ShapeEstimate::likelihood
  double fit = 0;                 ///< probability of a fit as bad as this or worse
  std::vector<double> curvature;  ///< [taxels] [1/m]
};

}  // namespace fsr::calibration
