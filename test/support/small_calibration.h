#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace test_support {

/// A calibration with smallTables() and only the other values that a file needs.
fsr::calibration::Calibration smallCalibration(fsr::matrix::MatrixSize size,
                                               const std::vector<double>& curvatures,
                                               const std::string& serial = "board-1",
                                               std::uint16_t full_scale = 1023);

}  // namespace test_support
