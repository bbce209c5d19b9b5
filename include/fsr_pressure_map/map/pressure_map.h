#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::map {

/// State of a whole map. The numbers are those of PressureMap.msg.
enum class MapState : std::uint8_t {
  kOk = 0,
  kUncalibrated = 1,      ///< all pressures are NaN
  kCurvatureUnknown = 2,  ///< no curvature was received: the calibration's fallback was used
  kCurvatureStale = 3,
  kSizeMismatch = 4,  ///< all pressures are NaN
  kWrongSensor = 5,   ///< the board's serial number is not that of the calibration
};

/// Flags of one taxel. The numbers are those of PressureMap.msg.
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
constexpr std::uint16_t kHistoryShort =
    4096;  ///< what is not known of the load before more than doubles the deviation
}  // namespace taxel_flag

/// Whether the pressure of a taxel with these flags is at least its reading: at full scale, or a code above
/// those of training on a trained curvature and temperature. A masked or failed taxel gives no limit.
constexpr bool isLowerLimit(std::uint16_t flags) {
  using namespace taxel_flag;
  constexpr std::uint16_t kNoReading = kMasked | kDead | kStuck | kLineFault | kFilled;
  constexpr std::uint16_t kOther = kBelowRange | kCurvatureExtrapolated | kTemperatureExtrapolated;
  if ((flags & kNoReading) != 0) return false;
  return (flags & kSaturated) != 0 || ((flags & kReadingExtrapolated) != 0 && (flags & kOther) == 0);
}

/// Whether a taxel has a reading of its own: a pressure, and neither masked nor failed.
bool hasReading(float pressure, std::uint16_t flags);

/// Part of the taxels with a reading that carry kHistoryShort, 0 to 1; 0 without readings. Both arrays have
/// one value for each taxel.
double unsettledShare(const std::vector<float>& pressure, const std::vector<std::uint16_t>& flags);

/// Calibrated gauge pressure of each taxel.
struct PressureMap {
  matrix::Layout layout;
  MapState state = MapState::kUncalibrated;
  std::vector<float> pressure;       ///< [rows x columns], row-major [Pa]; NaN = no reading, never Inf
  std::vector<float> deviation;      ///< standard deviation of a held-out reading [Pa], same order
  std::vector<std::uint16_t> flags;  ///< taxel_flag bits, same order

  /// Sets the layout, pressures and deviations to NaN and flags to 0. Allocates only where the size
  /// increases.
  void reset(const matrix::Layout& new_layout);
};

/// Makes `peaks` the map of the highest pressure of each taxel, with its deviation and flags: those of `map`
/// where it is higher, where `peaks` has no reading, or where `peaks` is of another size. The state is that
/// of `map`.
void holdPeaks(const PressureMap& map, PressureMap& peaks);

}  // namespace fsr::map
