#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::map {

/// State of a whole map; the numbers are those of PressureMap.msg.
enum class MapState : std::uint8_t {
  kOk = 0,
  kUncalibrated = 1,      ///< pressure is all NaN
  kCurvatureUnknown = 2,  ///< none received: the calibration's stated fallback was used
  kCurvatureStale = 3,
  kSizeMismatch = 4,  ///< pressure is all NaN
  kWrongSensor = 5,   ///< the board's serial number is not the calibration's
};

/// Flags of one taxel; the numbers are those of PressureMap.msg.
namespace taxel_flag {
constexpr std::uint16_t kSaturated = 1;
constexpr std::uint16_t kDead = 2;
constexpr std::uint16_t kStuck = 4;
constexpr std::uint16_t kReadingExtrapolated = 8;
constexpr std::uint16_t kCurvatureExtrapolated = 16;
constexpr std::uint16_t kBetweenClasses = 32;
constexpr std::uint16_t kFilled = 64;
constexpr std::uint16_t kMasked = 128;
constexpr std::uint16_t kLineFault = 256;
constexpr std::uint16_t kTared = 512;
constexpr std::uint16_t kBelowRange = 1024;
constexpr std::uint16_t kTemperatureExtrapolated = 2048;
}  // namespace taxel_flag

/// Calibrated gauge pressure of each taxel.
struct PressureMap {
  matrix::Layout layout;
  MapState state = MapState::kUncalibrated;
  std::vector<float> pressure;       ///< [rows x columns], row-major [Pa]; NaN = no reading, never Inf
  std::vector<float> deviation;      ///< one standard deviation of a held-out reading [Pa], likewise
  std::vector<std::uint16_t> flags;  ///< taxel_flag bits, likewise

  /// Makes room for `layout` and fills with NaN, NaN and 0; allocates only where the size grows.
  void reset(const matrix::Layout& new_layout);
};

}  // namespace fsr::map
