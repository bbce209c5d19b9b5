// consumer FOLDER: trains a calibration on a synthetic recording, saves and loads it in FOLDER, and measures
// one scan. Uses the installed headers and library only. Returns 0 if the measured pressure is close to the
// applied one.
#include <fsr_pressure_map/calibration/calibration.h>
#include <fsr_pressure_map/calibration/calibration_file.h>
#include <fsr_pressure_map/calibration/calibrator.h>
#include <fsr_pressure_map/dataset/recording.h>
#include <fsr_pressure_map/map/map_statistics.h>
#include <fsr_pressure_map/view/bent_sheet.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr std::uint16_t kFullScale = 1023;
constexpr double kPeak = 600e3;             // [Pa]
constexpr std::size_t kCycles = 5;          // on each surface
constexpr std::size_t kScansPerCycle = 80;  // so a step of pressure is 15 kPa
constexpr double kPitch = 0.010;            // [m]

// The answer may differ from the applied pressure by one step of the training data.
constexpr double kTolerance = 2 * kPeak / kScansPerCycle;  // [Pa]

// Counts of a taxel at a gauge pressure [Pa] on a curvature [1/m]: bending reduces the sensitivity.
std::uint16_t countsOf(double pressure, double curvature, std::size_t taxel) {
  const double gain = (0.90 + 0.01 * static_cast<double>(taxel)) * (1 - 0.01 * curvature);
  return static_cast<std::uint16_t>(std::lround(0.95 * kFullScale * gain * std::sqrt(pressure / kPeak)));
}

fsr::matrix::Surface surfaceOf(const std::string& name, double curvature) {
  fsr::matrix::Surface surface;
  surface.name = name;
  surface.mount = 1;
  surface.curvature = {{curvature, 0, 0}};
  return surface;
}

// Triangular pressure cycles at 10 Hz, first on a flat surface, then on a cylinder.
fsr::dataset::Recording recordingOf(const std::vector<fsr::matrix::Surface>& surfaces) {
  fsr::dataset::Recording recording;
  recording.name = "synthetic";
  recording.layout.size = {2, 3};
  recording.layout.pitch_x = recording.layout.pitch_y = kPitch;
  recording.full_scale = kFullScale;
  recording.conditions = surfaces;
  for (std::uint32_t condition = 0; condition < surfaces.size(); ++condition) {
    for (std::size_t scan = 0; scan < kCycles * kScansPerCycle; ++scan) {
      const double phase = static_cast<double>(scan % kScansPerCycle) / kScansPerCycle;
      const double pressure = kPeak * (1 - std::abs(2 * phase - 1));
      recording.time.push_back(0.1 * static_cast<double>(recording.time.size()));
      recording.pressure.push_back(pressure);
      recording.condition.push_back(condition);
      for (std::size_t taxel = 0; taxel < recording.layout.size.taxels(); ++taxel) {
        recording.counts.push_back(countsOf(pressure, surfaces[condition].curvature[0].x, taxel));
      }
    }
  }
  return recording;
}

// Measures a scan of uniform pressure and compares the mean of the map with it.
bool measures(fsr::calibration::Calibrator& calibrator, const fsr::matrix::Surface& surface, double applied) {
  fsr::matrix::Scan scan;
  scan.size = calibrator.layout().size;
  scan.full_scale = kFullScale;
  for (std::size_t taxel = 0; taxel < scan.size.taxels(); ++taxel) {
    scan.counts.push_back(countsOf(applied, surface.curvature[0].x, taxel));
  }
  fsr::map::PressureMap map;
  calibrator.setSurface(surface, 0);
  calibrator.calibrate(fsr::matrix::view(scan), 0, map);
  const std::vector<double> areas = fsr::view::taxelAreas(calibrator.layout(), surface);
  const fsr::map::RegionStatistics whole = fsr::map::regionStatistics(map, {}, areas, 10e3);
  std::cout << surface.name << ": applied " << applied / 1000 << " kPa, mean " << whole.mean / 1000
            << " kPa, peak " << whole.peak / 1000 << " kPa, force " << whole.force << " N\n";
  const double flat_area =
      kPitch * kPitch * static_cast<double>(areas.size());  // a cylinder keeps areas [m^2]
  return map.state == fsr::map::MapState::kOk && std::abs(whole.mean - applied) < kTolerance &&
         whole.peak >= whole.mean && std::abs(whole.force / (whole.mean * flat_area) - 1) < 1e-3;
}

bool run(const std::string& folder) {
  const std::vector<fsr::matrix::Surface> surfaces = {surfaceOf("flat", 0), surfaceOf("cylinder", 14.25)};
  fsr::calibration::CalibrationProblem problem;
  problem.recordings = {recordingOf(surfaces)};
  const std::string path = folder + "/calibration.h5";
  const std::string id = fsr::calibration::saveCalibration(fsr::calibration::calibrate(problem), path);

  const fsr::calibration::Calibration loaded = fsr::calibration::loadCalibration(path);
  fsr::calibration::Calibrator calibrator(loaded.tables, loaded.layout);
  bool good = !id.empty() && loaded.id == id;
  for (const fsr::matrix::Surface& surface : surfaces) {
    for (const double applied : {120e3, 300e3, 480e3}) good = measures(calibrator, surface, applied) && good;
  }
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 2 && run(argv[1])) return 0;
    std::cerr << (argc == 2 ? "the calibration does not give the applied pressure back\n"
                            : "usage: consumer FOLDER\n");
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return 1;
}
