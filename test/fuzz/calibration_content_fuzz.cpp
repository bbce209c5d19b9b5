// A calibration file with a right hash may still hold anything: what loads gives maps without Inf, and
// without NaN that no flag explains.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "support/small_calibration.h"

namespace {

// Numbers off the input, zeros behind its end.
class Numbers {
 public:
  Numbers(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  bool any() const { return size_ > 0; }
  template <typename T>
  T next() {
    T value{};
    const std::size_t taken = std::min(sizeof(T), size_);
    std::memcpy(&value, bytes_, taken);
    bytes_ += taken;
    size_ -= taken;
    return value;
  }

 private:
  const std::uint8_t* bytes_;
  std::size_t size_;
};

// Overwrites numbers of a sound calibration with whatever the input says.
void disturb(fsr::Calibration& calibration, Numbers& numbers) {
  while (numbers.any()) {
    auto& tables = calibration.tables.tables;
    fsr::CodeTable& table = tables[numbers.next<std::uint8_t>() % tables.size()];
    const auto place = numbers.next<std::uint8_t>();
    const auto value = numbers.next<float>();
    switch (place % 8) {
      case 0:
        table.pressure[place / 8 % table.pressure.size()] = value;
        break;
      case 1:
        table.deviation[place / 8 % table.deviation.size()] = value;
        break;
      case 2:
        table.lowest = static_cast<std::uint16_t>(place * 257);
        break;
      case 3:
        table.highest = static_cast<std::uint16_t>(place * 257);
        break;
      case 4:
        calibration.tables.classes.back().curvature.front() = value;
        break;
      case 5:
        calibration.layout.pitch_x = value;
        break;
      case 6:
        calibration.trained.curvature = {value, -value};
        break;
      default:
        std::fill(table.pressure.begin(), table.pressure.end(), value);
    }
  }
}

void tryMaps(const fsr::Calibration& calibration) {
  fsr::Calibrator calibrator(calibration.tables, calibration.layout);
  fsr::PressureMap map;
  const std::size_t taxels = calibration.layout.size.taxels();
  for (unsigned code = 0; code <= calibration.tables.full_scale; ++code) {
    const std::vector<std::uint16_t> counts(taxels, static_cast<std::uint16_t>(code));
    calibrator.calibrate({calibration.layout.size, calibration.tables.full_scale, counts.data(), taxels},
                         0.1 * code, map);
    for (std::size_t i = 0; i < map.pressure.size(); ++i) {
      fuzz::require(!std::isinf(map.pressure[i]) && (map.flags[i] != 0 || !std::isnan(map.pressure[i])));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const std::string path = "/dev/shm/fsr_fuzz_" + std::to_string(getpid()) + ".h5";
  fsr::Calibration calibration = test_support::smallCalibration({1, 2}, {0.0, 10.0}, "fuzz", 31);
  Numbers numbers(bytes, size);
  disturb(calibration, numbers);
  try {
    fsr::saveCalibration(calibration, path);
    tryMaps(fsr::loadCalibration(path));
  } catch (const fsr::InputError&) {
  }
  std::filesystem::remove(path);
  return 0;
}
