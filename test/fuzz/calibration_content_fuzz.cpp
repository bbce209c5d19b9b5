// A calibration file with a right hash may contain anything: missing objects, objects of another type or
// shape, and any number. A file that loads must give maps without Inf, and without NaN that has no flag.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "fuzz/hdf5_damage.h"
#include "settings/sha256.h"
#include "support/synthetic_recording.h"

namespace {

constexpr std::uint16_t kFullScale = 31;

// A model of the sheet's memory with every operator.
fsr::calibration::HistoryModel someHistory() {
  fsr::calibration::HistoryModel model;
  model.family = fsr::calibration::HistoryFamily::kBoth;
  model.knot = model.deviation_knot = {0, 300e3, 600e3};
  model.correction = {1e3, 0, -1e3};
  model.radius = {10e3, 60e3};
  model.play_weight = {-0.3, -0.1};
  model.time_constant = {0.3, 5};
  model.memory_weight = {-0.05, -0.02};
  model.loading_deviation = model.unloading_deviation = {2e3, 3e3, 4e3};
  return model;
}

// The bytes of a valid file with all that training writes, one for each rule of handling curvature.
std::string soundFile(fsr::compensation::Scheme scheme, const fsr::calibration::HistoryModel& history = {}) {
  test_support::SyntheticRig rig;
  rig.size = {1, 2};
  rig.full_scale = kFullScale;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_10cm", 10.0}, {"cylinder_5cm", 20.0}, {"cylinder_4cm", 25.0}};
  rig.scans_per_cycle = 40;
  fsr::calibration::CalibrationProblem problem{{test_support::syntheticRecording(rig)}, {}};
  problem.options.scheme = scheme;
  const std::string path = "/dev/shm/fsr_fuzz_" + std::to_string(getpid()) + ".h5";
  fsr::calibration::Calibration calibration = fsr::calibration::calibrate(problem);
  calibration.history = history;
  if (history.present()) calibration.temperature = {-0.004, 25, 60, 20, 30, 3};
  fsr::calibration::saveCalibration(calibration, path);
  std::ifstream file(path, std::ios::binary);
  std::filesystem::remove(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::vector<std::string>& soundFiles() {
  static const std::vector<std::string> files = {
      soundFile(fsr::compensation::Scheme::kPerCurvature),
      soundFile(fsr::compensation::Scheme::kScaledCurvature),
      soundFile(fsr::compensation::Scheme::kCurvatureMap), soundFile(fsr::compensation::Scheme::kPerSurface),
      soundFile(fsr::compensation::Scheme::kInterpolated, someHistory())};
  return files;
}

// The number of the schema must fit the content, or nothing behind it is read.
std::uint64_t schemaOf(const std::string& file) {
  const std::size_t place = file.find("schema=");
  return static_cast<std::uint64_t>(file.at(place + 7) - '0');
}

void seal(std::string& file, std::uint64_t schema) {
  const std::string hash =
      fsr::settings::sha256(file.data() + fsr::hdf5::kUserBlock, file.size() - fsr::hdf5::kUserBlock);
  const std::string line =
      "fsr_pressure_map calibration schema=" + std::to_string(schema) + " sha256=" + hash + "\n";
  file.replace(0, line.size(), line);
}

void tryMaps(fsr::calibration::Calibrator& calibrator) {
  fsr::map::PressureMap map;
  const fsr::matrix::MatrixSize size = calibrator.layout().size;
  for (unsigned code = 0; code <= kFullScale; ++code) {
    const std::vector<std::uint16_t> counts(size.taxels(), static_cast<std::uint16_t>(code));
    if (code > 3) calibrator.setTemperature(10.0 * code, 20, 30);
    calibrator.calibrate({size, kFullScale, counts.data(), counts.size()}, 0.1 * code, map);
    if (map.state == fsr::map::MapState::kSizeMismatch) return;
    for (std::size_t i = 0; i < map.pressure.size(); ++i) {
      fuzz::require(!std::isinf(map.pressure[i]) && (map.flags[i] != 0 || !std::isnan(map.pressure[i])));
    }
  }
}

void use(const fsr::calibration::Calibration& calibration) {
  fsr::calibration::Calibrator calibrator(calibration);
  tryMaps(calibrator);
  for (const double curvature : {0.0, 9.9, 17.0, -40.0, 90.0}) {
    calibrator.setSurface({"cylinder_10cm", 1, {{curvature, 0, 0}}, {}}, 0);
    tryMaps(calibrator);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::Numbers numbers(bytes, size);
  std::string file = soundFiles()[numbers.next<std::uint8_t>() % soundFiles().size()];
  const std::uint64_t schema = schemaOf(file);
  file = std::string(fsr::hdf5::kUserBlock, '\0') + fuzz::damaged(file, numbers);
  seal(file, schema);
  const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  try {
    use(fsr::calibration::loadCalibration(written.path(), fsr::calibration::CalibrationParts::kAll));
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
