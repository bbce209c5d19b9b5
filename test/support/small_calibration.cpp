#include "support/small_calibration.h"

#include "support/small_tables.h"

namespace test_support {

fsr::calibration::Calibration smallCalibration(fsr::matrix::MatrixSize size,
                                               const std::vector<double>& curvatures,
                                               const std::string& serial, std::uint16_t full_scale) {
  fsr::calibration::Calibration calibration;
  calibration.folds = 5;
  calibration.sensor.serial = serial;
  calibration.layout = {size, 0.010, 0.012};
  calibration.no_model.assign(size.taxels(), 0);
  calibration.tables = smallTables(size, curvatures, full_scale);
  calibration.trained.pressure = {0.0, 620e3};
  calibration.trained.curvature = {curvatures.front(), curvatures.back()};
  calibration.provenance.date = "2024-05-17T09:30:00Z";
  calibration.provenance.tool_version = "test";
  return calibration;
}

}  // namespace test_support
