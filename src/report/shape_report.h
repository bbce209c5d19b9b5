#pragma once

#include <string>
#include <vector>

#include "calibration/shape/mount_checks.h"

namespace fsr::report {

/// Tables of the mounts: what the sheet says of each, and how its bend changes along it; what training fixes;
/// and a sentence where a surface disagrees or nothing can be told.
std::string shapeText(const compensation::ShapeModel& model,
                      const std::vector<calibration::CheckedMount>& mounts);

}  // namespace fsr::report
