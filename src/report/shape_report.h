#pragma once

#include <string>
#include <vector>

#include "calibration/shape/mount_checks.h"

namespace fsr::report {

/// A table of the mounts and what the sheet says of each, with a sentence where a surface disagrees or
/// nothing can be told.
std::string shapeText(const compensation::ShapeModel& model,
                      const std::vector<calibration::CheckedMount>& mounts);

}  // namespace fsr::report
