#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr::calibration {

/// Chooses the curvature class of each taxel: the nearest by principal curvature. While the sheet stays on
/// one surface and mount there is hysteresis, so that a curvature near the middle of two classes does not
/// make the pressure jump between them. If the rule is by name, a surface with the name of a class gets that
/// class, whatever its curvature, and any other surface is between classes.
class ClassSwitch {
 public:
  /// A taxel changes its class only if another is nearer by more than `hysteresis` [1/m]. Only classes,
  /// range, tolerance and rule of `tables` are used.
  ClassSwitch(const compensation::CurvatureTables& tables, double hysteresis);

  /// Chooses the classes for a surface of known curvature that fits the matrix.
  void choose(const matrix::Surface& surface);

  /// Chooses the flattest class of each taxel, for an unknown curvature.
  void fallBack();

  /// [rows x columns], row-major.
  const std::vector<ClassChoice>& choices() const { return choices_; }

 private:
  std::size_t nearest(std::size_t taxel, double curvature) const;
  bool chooseByName(const std::string& name);
  std::size_t keepOrLeave(std::size_t taxel, double curvature) const;
  double distance(std::size_t taxel, std::size_t curvature_class, double curvature) const;
  std::uint16_t flags(std::size_t taxel, std::size_t curvature_class, double curvature) const;

  std::vector<dataset::CurvatureClass> classes_;
  double low_;
  double high_;
  double tolerance_;
  double hysteresis_;
  bool by_name_;
  matrix::Surface last_;  // name and mount only; unknown after fallBack()
  std::vector<ClassChoice> choices_;
};

}  // namespace fsr::calibration
