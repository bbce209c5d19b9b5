#pragma once

#include <cmath>
#include <vector>

#include "calibration/stages/session/tare.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace test_support {

/// RMSE of the live map on recordings whose counts are in memory [Pa], with a tare at the start of each
/// session where the calibration expects one. Readings of 0 counts have no error.
inline double liveRmse(const fsr::calibration::Calibration& calibration,
                       const std::vector<fsr::dataset::Recording>& recordings) {
  double square = 0, readings = 0;
  fsr::map::PressureMap map;
  for (const fsr::dataset::Recording& recording : recordings) {
    fsr::calibration::Calibrator calibrator(calibration);
    const std::size_t taxels = recording.layout.size.taxels();
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const std::size_t condition = recording.condition[i];
      if (i == 0 || condition != recording.condition[i - 1]) {
        const std::vector<float> tare = tareAtStart(calibration, recording, condition);
        calibrator.setSurface(recording.conditions[condition], recording.time[i]);
        calibrator.setTare(tare);
        if (!tare.empty()) calibrator.markRest();
      }
      setTemperatureOf(recording, i, calibration, calibrator);
      const std::uint16_t* const counts = recording.counts.data() + i * taxels;
      calibrator.calibrate({recording.layout.size, recording.full_scale, counts, taxels}, recording.time[i],
                           map);
      for (std::size_t t = 0; t < taxels; ++t) {
        const double error = map.pressure[t] - recording.pressure[i];
        if (counts[t] == 0 || (map.flags[t] & fsr::map::taxel_flag::kSaturated) != 0 || std::isnan(error))
          continue;
        square += error * error;
        readings += 1;
      }
    }
  }
  return std::sqrt(square / readings);
}

}  // namespace test_support
