#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/rig.h"

namespace fsr::simulation {

/// Callbacks for the data of a simulated rig. Times are rig time [s]. Calls come in time order.
struct RigListener {
  std::function<void(double time, const std::vector<std::uint16_t>& counts)> scan;
  std::function<void(double time, std::int32_t counts)> transducer;
  std::function<void(double time, double temperature)> temperature;  ///< [degree Celsius]
};

/// Runs the stations of a simulation one after the other. The sheet keeps its state from one station to the
/// next.
class Session {
 public:
  /// Throws InputError where a station's program never ends.
  explicit Session(const SimulationSettings& settings);

  /// Continues after another session or a driven rig. The date of the state replaces that of the settings,
  /// the first station also has its pause, and the numbers of the mounts continue. Throws InputError where
  /// the state belongs to another rig.
  void resume(const RigState& state);
  RigState state() const;

  /// Date of rig time 0 [ns since 1970].
  std::int64_t origin() const { return origin_ns_; }
  std::size_t stations() const { return settings_.session.size(); }
  const Station& station(std::size_t i) const { return settings_.session.at(i); }
  /// Rig time at which the next station begins [s].
  double begin() const;

  /// Runs the next station: pause, mount, program. Scans and transducer have the rates of the board, and the
  /// thermometer gives one reading a second. All start at the begin of the station.
  void runNext(const RigListener& listener);

 private:
  SimulationSettings settings_;
  Rig rig_;
  std::int64_t origin_ns_;
  std::size_t next_ = 0;
  bool resumed_ = false;
  double time_ = 0;  // when the last station ended [s]
};

/// The identity of the simulated sensor in a recording.
dataset::SensorIdentity identity(const SimulationSettings& settings);

/// "1_flat", "2_cylinder_5cm": name of a station's bag, without its ending.
std::string stationName(const Station& station);

}  // namespace fsr::simulation
