#include "simulation/rig.h"

namespace fsr::simulation {

Rig::Rig(const SimulationSettings& settings)
    : chain_(settings), reference_(settings), gas_(settings.climate) {}

const std::vector<std::uint16_t>& Rig::scan(double time, const PressureCourse& pressure) {
  RigSample sample;
  sample.time = time;
  sample.pressure = pressure(time);
  sample.scan = scans_++;
  sample.temperature = gas_.temperature(time, sample.pressure);
  sample.course = &pressure;
  return chain_.read(sample);
}

std::int32_t Rig::transducer(double time, const PressureCourse& pressure) const {
  return reference_.counts(pressure(time));
}

double Rig::temperature(double time, const PressureCourse& pressure) {
  return gas_.temperature(time, pressure(time));
}

void Rig::save(RigState& state) const {
  state.scans = scans_;
  state.gas = gas_.state();
  state.sheet = chain_.state();
}

void Rig::restore(const RigState& state) {
  chain_.restore(state.sheet);
  if (state.gas.size() == gas_.state().size()) gas_.state() = state.gas;
  scans_ = state.scans;
}

}  // namespace fsr::simulation
