#pragma once

#include <string>
#include <variant>
#include <vector>

#include "fsr_pressure_map/simulation/chamber_protocol.h"

namespace fsr::simulation {

/// Step or ramp to a pressure, and stay there.
struct HoldPart {
  double pressure = 0;  ///< gauge [Pa]
  double rate = 17e3;   ///< [Pa/s]
  double duration = 0;  ///< [s]
};

/// Minor loops; begins and ends at `low`.
struct LoopsPart {
  double low = 0;      ///< gauge [Pa]
  double high = 0;     ///< gauge [Pa]
  double rate = 17e3;  ///< [Pa/s]
  unsigned loops = 1;
};

/// Vent, and wait.
struct RestPart {
  double rate = 17e3;   ///< [Pa/s]
  double duration = 0;  ///< [s]
};

/// Cycles begin and end at rest.
using ProgramPart = std::variant<ChamberProtocol, HoldPart, LoopsPart, RestPart>;

/// What the chamber does, part after part, each starting at the pressure where the one before ended.
using ChamberProgram = std::vector<ProgramPart>;

}  // namespace fsr::simulation
