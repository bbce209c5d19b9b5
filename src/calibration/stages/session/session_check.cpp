#include "calibration/stages/session/session_check.h"

#include <cmath>

#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/session/tare.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/calibration/calibrator.h"

namespace fsr::calibration {

std::vector<float> tareAtStart(const Calibration& calibration, const dataset::Recording& recording,
                               std::size_t condition) {
  if (!calibration.session_zero.expected()) return {};
  const std::vector<std::size_t> rest = restAtStart(recording, condition);
  if (rest.empty()) return {};
  const std::size_t taxels = recording.layout.size.taxels();
  Calibrator calibrator(calibration.tables, calibration.layout);
  calibrator.setMask(recording.mask);
  calibrator.setSurface(recording.conditions[condition], recording.time[rest.front()]);
  map::PressureMap map;
  std::vector<double> sum(taxels, 0), count(taxels, 0);
  dataset::ScanCounts counts(recording);
  for (const std::size_t scan : rest) {
    calibrator.calibrate({recording.layout.size, recording.full_scale, counts[scan], taxels},
                         recording.time[scan], map);
    for (std::size_t i = 0; i < taxels; ++i) {
      if (!std::isfinite(map.pressure[i]) || (map.flags[i] & map::taxel_flag::kSaturated) != 0) continue;
      sum[i] += double(map.pressure[i]) - recording.pressure[scan];
      count[i] += 1;
    }
  }
  const std::vector<float> training = restOfTraining(calibration.session_zero, calibrator);
  std::vector<float> offset(taxels, 0.0F);
  for (std::size_t i = 0; i < taxels; ++i) {
    if (count[i] > 0) offset[i] = static_cast<float>(sum[i] / count[i]) - training[i];
  }
  return offset;
}

}  // namespace fsr::calibration
