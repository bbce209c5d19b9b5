#pragma once

#include <cstddef>
#include <vector>

namespace fsr::compensation {

/// How the tables of a taxel's curvature classes become the one table for the curvature at hand.
enum class BlendRule {
  kNearest,      ///< the nearest class's table
  kKernel,       ///< a GRNN's mean of all of them, weighted by distance in reading and curvature
  kInterpolate,  ///< linear in curvature between the two neighbours' pressures at a code
  kByName,       ///< the table of the surface's name; nearest where there is none of that name
};

/// A monotone law of the matrix between its classes: pressure at curvature k = gain(k) P(code) + offset(k),
/// P being the taxel's table without bending effects. Straight interpolation between two classes cuts
/// the bend of this law off; the law puts it back.
struct EffectLaw {
  std::vector<double> curvature;  ///< knots, ascending [1/m]; empty = none
  std::vector<double> gain;       ///< of each knot
  std::vector<double> offset;     ///< likewise [Pa]

  struct Effect {
    double gain;
    double offset;  // [Pa]
  };
  /// By monotone cubic (Fritsch and Carlson) between the knots, level beyond them.
  Effect at(double curvature) const;
};

/// What to do to the straight interpolation between two classes so that it follows a law: gain P + offset.
/// 1 and 0 where there is no law, and beyond the classes (`low` = `high`).
EffectLaw::Effect straightening(const EffectLaw& law, double low, double high, double share, double at);

/// How far predictions for a curvature that training left out were off, beyond the stated deviation, by
/// pressure: what a reading midway between two classes is uncertain by.
struct UnseenDeviation {
  std::vector<double> pressure;   ///< knots, ascending [Pa]; empty = not known
  std::vector<double> deviation;  ///< of each knot [Pa]

  /// Linear between the knots, level beyond them. Not to be called where nothing is known.
  double at(double pressure) const;
};

struct CurvatureRule {
  BlendRule blend = BlendRule::kNearest;
  /// Which model each class has its tables from, where classes share one; empty = each has its own.
  std::vector<std::size_t> model_of_class;
  /// kKernel: distance in curvature at which a class's weight falls by e^-1/2, one for all taxels or one
  /// each [1/m]; infinite = curvature has no effect.
  std::vector<double> length_scale;
  EffectLaw law;           ///< kInterpolate: curvature_map's
  UnseenDeviation unseen;  ///< found by leaving each inner class out

  double lengthScale(std::size_t taxel) const {
    return length_scale.size() == 1 ? length_scale.front() : length_scale.at(taxel);
  }
};

}  // namespace fsr::compensation
