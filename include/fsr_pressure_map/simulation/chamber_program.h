#pragma once

#include <vector>

#include "fsr_pressure_map/settings/settings.h"
#include "fsr_pressure_map/simulation/pressure_profile.h"

namespace fsr {

/// Reads what the chamber does, part after part, each starting at the pressure where the one before
/// ended. Each part is a mapping with one key:
///
///     - cycles: {peak: 620000, rate: 17000, ...}                # see readChamberProtocol(); from rest to
///     rest
///     - hold: {pressure: 300000, rate: 100000, duration: 300}   # step or ramp to a pressure, and stay there
///     - loops: {low: 200000, high: 400000, rate: 17000, loops: 4}   # minor loops; begins and ends at `low`
///     - rest: {rate: 17000, duration: 600}                      # vent, and wait
///
/// Pressures are gauge [Pa], rates [Pa/s], durations [s]. Throws InputError that names what is missing or
/// out of range, also where something follows cycles that never end.
PressureProfile readChamberProgram(const std::vector<Settings>& parts);

}  // namespace fsr
