#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/effect.h"

namespace fsr::simulation {

/// The chamber's own gauge beside the sensor chain: gauge pressure in, through the effects of the stage
/// kReference and the transducer's converter, what a recording says out.
class ReferenceChannel {
 public:
  /// Throws InputError.
  explicit ReferenceChannel(const SimulationSettings& settings);

  /// What the transducer shows before its converter [Pa].
  double indicated(double pressure) const;
  /// The other path lengthround: the chamber's pressure when the transducer shows that [Pa].
  double truePressure(double indicated) const;

  /// What its converter makes of the chamber's pressure [Pa].
  std::int32_t counts(double pressure) const { return transducer_.counts(indicated(pressure)); }

 private:
  Transducer transducer_;
  std::vector<std::unique_ptr<Effect>> effects_;
};

}  // namespace fsr::simulation
