#include "simulation/pressure_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fsr::simulation {

namespace {

void check(const std::vector<PressurePoint>& points) {
  const auto later = [](const PressurePoint& a, const PressurePoint& b) { return !(a.time <= b.time); };
  if (points.size() < 2 || points.front().time != 0 || !(points.back().time > 0) ||
      std::adjacent_find(points.begin(), points.end(), later) != points.end()) {
    throw std::invalid_argument("a part of a pressure profile needs times that ascend from 0");
  }
}

double interpolate(const std::vector<PressurePoint>& points, double time) {
  const auto next = std::upper_bound(points.begin(), points.end(), time,
                                     [](double t, const PressurePoint& point) { return t < point.time; });
  if (next == points.begin()) return points.front().pressure;
  if (next == points.end()) return points.back().pressure;
  const PressurePoint& from = *(next - 1);
  return from.pressure + (next->pressure - from.pressure) * (time - from.time) / (next->time - from.time);
}

}  // namespace

void PressureProfile::append(const std::vector<PressurePoint>& points, unsigned repeats) {
  check(points);
  const double start = duration();
  if (std::isinf(start)) throw std::invalid_argument("a part cannot follow one that repeats for ever");
  const double period = points.back().time;
  const double end = repeats == 0 ? std::numeric_limits<double>::infinity() : start + period * repeats;
  parts_.push_back({start, period, end, points});
}

double PressureProfile::duration() const {
  return parts_.empty() ? 0 : parts_.back().end;
}

double PressureProfile::at(double time) const {
  if (parts_.empty()) return 0;
  if (time >= duration()) return parts_.back().points.back().pressure;
  const auto part =
      std::find_if(parts_.begin(), parts_.end(), [time](const Part& p) { return time < p.end; });
  const double inside = std::max(time - part->start, 0.0);
  return interpolate(part->points, inside - std::floor(inside / part->period) * part->period);
}

}  // namespace fsr::simulation
