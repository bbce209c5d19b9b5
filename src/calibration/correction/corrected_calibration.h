#pragma once

#include <string>
#include <vector>

#include "calibration/correction/correction_fit.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// The parent with every table moved along the codes, so that it answers to a reading of today what it
/// answered to the reading that stood for the same load before. The map costs the same. `changes`: [taxels].
/// `larger`: factor of the deviations, 1 or more. The sums behind the tables are left out: they are of
/// readings before the change.
Calibration movedCalibration(const Calibration& parent, const std::vector<ReadingChange>& changes,
                             double larger);

/// "corrected on 2026-11-23 from 3f2a01c4d5e6"; "" for a calibration that was trained.
std::string correctionText(const Correction& correction);

}  // namespace fsr::calibration
