#include "ros/messages/surface_message.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/surface_file.h"
#include "settings/number_text.h"

namespace fsr_ros {

namespace {

constexpr auto kMaxCurvature = static_cast<float>(fsr::matrix::kMaxCurvature);

double valueAt(const std::vector<float>& values, std::size_t i) {
  if (values.empty()) return 0.0;
  return values.size() == 1 ? values.front() : values[i];
}

// The length of the longest array, at least 1.
std::size_t taxelsOf(const fsr_pressure_map::SurfaceCurvature& message) {
  return std::max({message.x.size(), message.y.size(), message.xy.size(), std::size_t{1}});
}

void checkArray(const std::vector<float>& values, const char* field, std::size_t taxels) {
  if (values.size() > 1 && values.size() != taxels) {
    throw fsr::settings::InputError(std::string("curvature message: ") + field + " has " +
                                    std::to_string(values.size()) + " values, but must have none, one or " +
                                    std::to_string(taxels) + " as the longest array");
  }
  for (const float value : values) {
    if (!std::isfinite(value)) {
      throw fsr::settings::InputError(
          std::string("curvature message: ") + field +
          " holds a value that is not finite, but must be in 1/m; leave it empty where unknown");
    }
    if (std::abs(value) > kMaxCurvature) {
      throw fsr::settings::InputError(std::string("curvature message: ") + field + " holds " +
                                      fsr::settings::roundedText(double(value)) +
                                      ", but must be -100 to 100 1/m (a bend radius of 10 mm or more)");
    }
  }
}

}  // namespace

fsr::matrix::Surface toSurface(const fsr_pressure_map::SurfaceCurvature& message) {
  const std::size_t taxels = taxelsOf(message);
  checkArray(message.x, "x", taxels);
  checkArray(message.y, "y", taxels);
  checkArray(message.xy, "xy", taxels);
  checkArray(message.deviation, "deviation", std::max(taxels, message.deviation.size()));

  fsr::matrix::Surface surface;
  surface.name = message.surface;
  surface.mount = message.mount;
  surface.deviation.assign(message.deviation.begin(), message.deviation.end());
  if (message.x.empty()) return surface;  // the message's definition says: an empty x means unknown
  surface.curvature.resize(taxels);
  for (std::size_t i = 0; i < taxels; ++i) {
    surface.curvature[i] = {valueAt(message.x, i), valueAt(message.y, i), valueAt(message.xy, i)};
  }
  return surface;
}

fsr_pressure_map::SurfaceCurvature toMessage(const fsr::matrix::Surface& surface) {
  fsr_pressure_map::SurfaceCurvature message;
  message.surface = surface.name;
  message.mount = surface.mount;
  for (const fsr::matrix::Curvature& curvature : surface.curvature) {
    message.x.push_back(static_cast<float>(curvature.x));
    message.y.push_back(static_cast<float>(curvature.y));
    message.xy.push_back(static_cast<float>(curvature.xy));
  }
  for (const double deviation : surface.deviation) message.deviation.push_back(static_cast<float>(deviation));
  return message;
}

}  // namespace fsr_ros
