#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/effect.h"

namespace fsr::simulation {

/// The chamber's pressure transducer. Input: the gauge pressure of the chamber. Output: the pressure that a
/// recording contains, after the effects of the stage kReference and the transducer's converter.
class ReferenceChannel {
 public:
  /// Throws InputError.
  explicit ReferenceChannel(const SimulationSettings& settings);

  /// What the transducer shows before its converter [Pa].
  double indicated(double pressure) const;
  /// Inverse of indicated(): the chamber's pressure when the transducer shows `indicated` [Pa].
  double truePressure(double indicated) const;

  /// What its converter makes of the chamber's pressure [Pa].
  std::int32_t counts(double pressure) const { return transducer_.counts(indicated(pressure)); }

 private:
  Transducer transducer_;
  std::vector<std::unique_ptr<Effect>> effects_;
};

}  // namespace fsr::simulation
