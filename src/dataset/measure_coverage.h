#pragma once

#include <vector>

#include "dataset/sections.h"
#include "fsr_pressure_map/dataset/condition_classes.h"

namespace fsr::dataset {

/// Coverage of given classes. `sections` has one entry for each recording.
Coverage measureCoverage(const std::vector<Recording>& recordings, const ConditionClasses& classes,
                         const std::vector<Sections>& sections);

}  // namespace fsr::dataset
