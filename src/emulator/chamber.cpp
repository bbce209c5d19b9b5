#include "emulator/chamber.h"

#include <algorithm>
#include <limits>

namespace fsr::emulator {

// Vents the chamber and returns the time at which it is at rest. A run that was commanded but has not begun,
// because the chamber is still venting, never begins.
double Chamber::vent(double time) {
  while (!sections_.empty() && sections_.back().start > time) sections_.pop_back();
  const simulation::PressureProfile venting = simulation::ventingProfile(protocol_, gaugePressure(time));
  sections_.push_back({time, venting});
  return time + venting.duration();
}

void Chamber::startCycles(double time, const simulation::ChamberProtocol& protocol) {
  const double at_rest = vent(time);
  protocol_ = protocol;
  sections_.push_back({at_rest, simulation::pressureProfile(protocol)});
  cycles_end_ = at_rest + sections_.back().profile.duration();
}

void Chamber::stop(double time) {
  vent(time);
  cycles_end_ = std::numeric_limits<double>::infinity();
}

double Chamber::gaugePressure(double time) const {
  const auto next = std::upper_bound(sections_.begin(), sections_.end(), time,
                                     [](double t, const Section& section) { return t < section.start; });
  return next == sections_.begin() ? 0.0 : (next - 1)->profile.at(time - (next - 1)->start);
}

}  // namespace fsr::emulator
