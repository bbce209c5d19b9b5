#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr::calibration {

/// Chooses the curvature class of each taxel: the nearest by principal curvature, with hysteresis while
/// the sheet stays on one surface and mount, so that a curvature that wavers between two classes does
/// not make the pressure jump to and fro. Where the rule is by name, a surface of a class's name takes that
/// class, whatever its curvature, and any other surface lies between classes.
class ClassSwitch {
 public:
  /// A taxel leaves its class only when another is nearer by more than `hysteresis` [1/m]. `tables` is
  /// read for its classes, range, tolerance and rule only.
  ClassSwitch(const compensation::CurvatureTables& tables, double hysteresis);

  /// Chooses anew for a surface of known curvature that fits the matrix.
  void choose(const matrix::Surface& surface);

  /// Curvature unknown: the flattest class of each taxel, which is what a calibration falls back to.
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
