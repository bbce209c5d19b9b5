// peaks BAG CALIBRATION: prints the highest pressure on each surface of a recording, with its standard
// deviation.
#include <fsr_pressure_map/calibration/calibration_file.h>
#include <fsr_pressure_map/calibration/calibrator.h>
#include <fsr_pressure_map/ros/bag_reader.h>

#include <exception>
#include <iostream>

namespace {

void printPeaks(const fsr::dataset::Recording& recording, const fsr::calibration::Calibration& calibration) {
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t condition = 0; condition < recording.conditions.size(); ++condition) {
    const fsr::matrix::Surface& surface = recording.conditions[condition];
    fsr::calibration::Calibrator calibrator(calibration);
    calibrator.setSurface(surface, 0);
    fsr::map::PressureMap map;
    float peak = 0, deviation = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (recording.condition[i] != condition) continue;
      calibrator.calibrate({recording.layout.size, recording.full_scale, recording.scan(i), taxels},
                           recording.time[i], map);
      for (std::size_t taxel = 0; taxel < map.pressure.size(); ++taxel) {
        if (!(map.pressure[taxel] > peak)) continue;  // NaN = no reading
        peak = map.pressure[taxel];
        deviation = map.deviation[taxel];
      }
    }
    std::cout << surface.name << ": " << peak / 1000 << " +- " << deviation / 1000 << " kPa\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: peaks BAG CALIBRATION\n";
    return 2;
  }
  try {
    printPeaks(fsr_ros::readBag(argv[1]), fsr::calibration::loadCalibration(argv[2]));
  } catch (const std::exception& error) {  // one sentence that names the file and what is wrong
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
