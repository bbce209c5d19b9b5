#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/compensation/curvature_rule.h"
#include "fsr_pressure_map/compensation/scheme.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/regression/code_table.h"

namespace fsr::compensation {

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
