#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/rig.h"

namespace fsr::simulation {

/// Who listens to a simulated rig; rig time [s]. Calls come in time order.
struct RigListener {
  std::function<void(double time, const std::vector<std::uint16_t>& counts)> scan;
  std::function<void(double time, std::int32_t counts)> transducer;
  std::function<void(double time, double temperature)> temperature;  ///< [degree Celsius]
};

/// What a rig is put through, station after station: the sheet goes from one surface to the next and
/// remembers what it went through.
class Session {
 public:
  /// Throws InputError where a station's program never ends.
  explicit Session(const SimulationSettings& settings);

  /// Goes on from where another session or a driven rig was left: its date holds instead of the settings',
  /// the first station has its pause before it too, and mounts are numbered on. Throws InputError where the
  /// state belongs to another rig.
  void resume(const RigState& state);
  RigState state() const;

  /// Date of rig time 0 [ns since 1970].
  std::int64_t origin() const { return origin_ns_; }
  std::size_t stations() const { return settings_.session.size(); }
  const Station& station(std::size_t i) const { return settings_.session.at(i); }
  /// Rig time at which the next station begins [s].
  double begin() const;

  /// Goes through the next station: pause, mount, program. Scans and transducer have the board's rates,
  /// the thermometer one reading a second, all from the station's begin.
  void runNext(const RigListener& listener);

 private:
  SimulationSettings settings_;
  Rig rig_;
  std::int64_t origin_ns_;
  std::size_t next_ = 0;
  bool resumed_ = false;
  double time_ = 0;  // when the last station ended [s]
};

/// How a recording names the simulated sensor.
dataset::SensorIdentity identity(const SimulationSettings& settings);

/// "1_flat", "2_cylinder_5cm": name of a station's bag, without its ending.
std::string stationName(const Station& station);

}  // namespace fsr::simulation
