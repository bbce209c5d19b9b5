#pragma once

#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/SurfaceCurvature.h>

#include <cstdint>
#include <vector>

namespace fsr_ros {

/// What a serialised message is made of, in order: 's' a string, a digit that many bytes, 'b', 'h', 'f' an
/// array of values of 1, 2, 4 bytes. True where every length stays within `bytes` and all of them are used.
bool lengthsFit(const std::vector<std::uint8_t>& bytes, const char* format);

/// Whether the arrays of a serialised message are as long as it says. Types without arrays pass: ROS reads
/// them within their bounds.
template <typename Message>
bool lengthsAreHonest(const std::vector<std::uint8_t>& /*bytes*/) {
  return true;
}
// Each begins with a std_msgs/Header: seq, stamp, frame_id.
template <>
inline bool lengthsAreHonest<fsr_pressure_map::MatrixFrame>(const std::vector<std::uint8_t>& bytes) {
  return lengthsFit(bytes,
                    "48s"
                    "484"
                    "222h");
}
template <>
inline bool lengthsAreHonest<fsr_pressure_map::SurfaceCurvature>(const std::vector<std::uint8_t>& bytes) {
  return lengthsFit(bytes,
                    "48s"
                    "s4ffff");
}
template <>
inline bool lengthsAreHonest<fsr_pressure_map::MatrixInfo>(const std::vector<std::uint8_t>& bytes) {
  return lengthsFit(bytes,
                    "48s"
                    "sssss222"
                    "4444"
                    "8sb");
}

}  // namespace fsr_ros
