#include "emulator/pressure_course.h"

#include <algorithm>
#include <cmath>

namespace fsr::emulator {

void PressureCourse::cut(double time) {
  const double pressure = at(time);
  while (points_.size() > 1 && points_.back().time >= time) points_.pop_back();
  if (points_.back().time < time) points_.push_back({time, pressure});
}

void PressureCourse::rampTo(double pressure, double rate) {
  moveTo(pressure, std::abs(pressure - this->pressure()) / rate);
}

void PressureCourse::moveTo(double pressure, double duration) {
  if (duration > 0) points_.push_back({end() + duration, pressure});
}

double PressureCourse::at(double time) const {
  const auto next =
      std::upper_bound(points_.begin(), points_.end(), time,
                       [](double t, const simulation::PressurePoint& point) { return t < point.time; });
  if (next == points_.begin()) return points_.front().pressure;
  if (next == points_.end()) return points_.back().pressure;
  const auto from = next - 1;
  return from->pressure + (next->pressure - from->pressure) * (time - from->time) / (next->time - from->time);
}

}  // namespace fsr::emulator
