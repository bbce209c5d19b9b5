#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/compensation/scheme.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/regression/code_table.h"

namespace fsr::compensation {

/// How the table of a taxel at any curvature is computed from the tables of its curvature classes.
enum class BlendRule {
  kNearest,      ///< the table of the nearest class
  kKernel,       ///< GRNN: mean of all classes, weighted by distance in reading and curvature
  kInterpolate,  ///< linear in curvature between the pressures of the two neighbouring classes at a code
  kByName,       ///< the table of the class with the name of the surface; the nearest class if there is none
};

/// A monotone function of curvature for the whole matrix: pressure at curvature k = gain(k) P(code) +
/// offset(k), where P is the taxel's table without bending effects. Linear interpolation between two classes
/// ignores the curve of this function; straightening() corrects for it.
struct EffectLaw {
  std::vector<double> curvature;  ///< knots, ascending [1/m]; empty = none
  std::vector<double> gain;       ///< of each knot
  std::vector<double> offset;     ///< likewise [Pa]

  struct Effect {
    double gain;
    double offset;  // [Pa]
  };
  /// Monotone cubic interpolation between the knots (Fritsch and Carlson 1980), constant beyond them.
  Effect at(double curvature) const;
};

/// Correction of the linear interpolation between two classes so that it follows a law: gain P + offset. 1
/// and 0 if there is no law, and beyond the classes (`low` = `high`).
EffectLaw::Effect straightening(const EffectLaw& law, double low, double high, double share, double at);

/// Error of predictions for curvatures that training left out, beyond the stated deviation, by pressure: the
/// uncertainty of a reading midway between two classes.
struct UnseenDeviation {
  std::vector<double> pressure;   ///< knots, ascending [Pa]; empty = not known
  std::vector<double> deviation;  ///< of each knot [Pa]

  /// Linear between the knots, constant beyond them. Must not be called if there are no knots.
  double at(double pressure) const;
};

struct CurvatureRule {
  BlendRule blend = BlendRule::kNearest;
  /// The model of each class, where classes share a model; empty = each class has its own.
  std::vector<std::size_t> model_of_class;
  /// kKernel: distance in curvature at which the weight of a class decreases by the factor e^-1/2, one for
  /// all taxels or one each [1/m]; infinite = curvature has no effect.
  std::vector<double> length_scale;
  EffectLaw law;           ///< kInterpolate: the law of curvature_map
  UnseenDeviation unseen;  ///< from leaving each inner class out in turn

  double lengthScale(std::size_t taxel) const {
    return length_scale.size() == 1 ? length_scale.front() : length_scale.at(taxel);
  }
};

/// The tables of a trained scheme: one CodeTable for each taxel and curvature class, and the rule that
/// computes from them the table at any curvature.
struct CurvatureTables {
  Scheme scheme = Scheme::kPerCurvature;
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;
  /// Classes by ascending curvature of taxel 0. Schemes that ignore curvature have one class.
  std::vector<dataset::CurvatureClass> classes;
  /// [taxels x classes], taxel by taxel.
  std::vector<regression::CodeTable> tables;
  /// Range of principal curvature over training [1/m]. A taxel outside it is flagged kCurvatureExtrapolated,
  /// whatever the scheme.
  double curvature_low = 0;
  double curvature_high = 0;
  /// A taxel farther than this from the curvatures of all classes is flagged kBetweenClasses [1/m].
  double class_tolerance = 0.5;
  CurvatureRule rule = {};

  const regression::CodeTable& table(std::size_t taxel, std::size_t curvature_class) const {
    return tables[taxel * classes.size() + curvature_class];
  }
};

}  // namespace fsr::compensation
