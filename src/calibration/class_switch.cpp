#include "calibration/class_switch.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::calibration {

ClassSwitch::ClassSwitch(const compensation::CurvatureTables& tables, double hysteresis)
    : classes_(tables.classes),
      low_(tables.curvature_low),
      high_(tables.curvature_high),
      tolerance_(tables.class_tolerance),
      hysteresis_(hysteresis),
      by_name_(tables.rule.blend == compensation::BlendRule::kByName),
      choices_(tables.size.taxels()) {
  fallBack();
}

void ClassSwitch::choose(const matrix::Surface& surface) {
  if (by_name_ && chooseByName(surface.name)) return;
  const bool same = last_.known() && last_.name == surface.name && last_.mount == surface.mount;
  for (std::size_t taxel = 0; taxel < choices_.size(); ++taxel) {
    const double curvature = matrix::principalCurvature(surface.at({taxel}));
    const std::size_t chosen = same ? keepOrLeave(taxel, curvature) : nearest(taxel, curvature);
    choices_[taxel] = {chosen, flags(taxel, chosen, curvature)};
    if (by_name_ && choices_[taxel].flags == 0) choices_[taxel].flags = map::taxel_flag::kBetweenClasses;
  }
  last_ = {surface.name, surface.mount, {matrix::Curvature{}}, {}};
}

bool ClassSwitch::chooseByName(const std::string& name) {
  const auto found = std::find_if(classes_.begin(), classes_.end(),
                                  [&](const dataset::CurvatureClass& one) { return one.surface == name; });
  if (found == classes_.end()) return false;
  choices_.assign(choices_.size(), {static_cast<std::size_t>(found - classes_.begin()), 0});
  last_ = {};
  return true;
}

void ClassSwitch::fallBack() {
  for (std::size_t taxel = 0; taxel < choices_.size(); ++taxel) choices_[taxel] = {nearest(taxel, 0.0), 0};
  last_ = {};
}

std::size_t ClassSwitch::nearest(std::size_t taxel, double curvature) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < classes_.size(); ++k) {
    if (distance(taxel, k, curvature) < distance(taxel, best, curvature)) best = k;
  }
  return best;
}

std::size_t ClassSwitch::keepOrLeave(std::size_t taxel, double curvature) const {
  const std::size_t now = choices_[taxel].curvature_class;
  const std::size_t best = nearest(taxel, curvature);
  const double gain = distance(taxel, now, curvature) - distance(taxel, best, curvature);
  return gain > hysteresis_ ? best : now;
}

double ClassSwitch::distance(std::size_t taxel, std::size_t curvature_class, double curvature) const {
  return std::abs(curvature - classes_[curvature_class].at(taxel));
}

// A curvature outside the range, but within the tolerance, counts as seen in training.
std::uint16_t ClassSwitch::flags(std::size_t taxel, std::size_t curvature_class, double curvature) const {
  if (curvature < low_ - tolerance_ || curvature > high_ + tolerance_) {
    return map::taxel_flag::kCurvatureExtrapolated;
  }
  const bool between = classes_.size() > 1 && distance(taxel, curvature_class, curvature) > tolerance_;
  return between ? map::taxel_flag::kBetweenClasses : std::uint16_t{0};
}

}  // namespace fsr::calibration
