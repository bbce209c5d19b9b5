#include "simulation/chamber_gas.h"

#include <algorithm>

#include "simulation/effect.h"

namespace fsr::simulation {

namespace {

// State: whether there was a call before, its time [s], its pressure [Pa], and the slow mean of the pressure
// [Pa].
enum { kGasStarted, kGasTime, kGasPressure, kGasSlow, kGasState };

}  // namespace

ChamberGas::ChamberGas(const ChamberClimate& climate)
    : climate_(climate), cooling_(climate.cooling), state_(kGasState) {}

double ChamberGas::room(double time) const {
  const auto& points = climate_.room;
  if (points.empty()) return kRoomTemperature;
  const auto next = std::find_if(points.begin(), points.end(),
                                 [time](const TemperaturePoint& point) { return point.time > time; });
  if (next == points.begin()) return points.front().temperature;
  if (next == points.end()) return points.back().temperature;
  const auto from = next - 1;
  const double share = (time - from->time) / (next->time - from->time);
  return from->temperature + share * (next->temperature - from->temperature);
}

double ChamberGas::temperature(double time, double pressure) {
  // dT/dt = c dP/dt - T / tau, T above the room. The solution is c times the pressure less its exponential
  // mean.
  const double slow = state_[kGasStarted] == 0 ? 0
                                               : cooling_.step(state_[kGasPressure], pressure,
                                                               time - state_[kGasTime], state_[kGasSlow]);
  state_ = {1, time, pressure, slow};
  return room(time) + climate_.heating * (pressure - slow);
}

}  // namespace fsr::simulation
