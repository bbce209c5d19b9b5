#pragma once

#include <string>
#include <variant>
#include <vector>

#include "fsr_pressure_map/simulation/chamber_protocol.h"

namespace fsr::simulation {

/// Step or ramp to a pressure, then hold it.
struct HoldPart {
  double pressure = 0;  ///< gauge [Pa]
  double rate = 17e3;   ///< [Pa/s]
  double duration = 0;  ///< [s]
};

/// Minor loops. They begin and end at `low`.
struct LoopsPart {
  double low = 0;      ///< gauge [Pa]
  double high = 0;     ///< gauge [Pa]
  double rate = 17e3;  ///< [Pa/s]
  unsigned loops = 1;
};

/// Vent to zero gauge pressure, then wait.
struct RestPart {
  double rate = 17e3;   ///< [Pa/s]
  double duration = 0;  ///< [s]
};

/// Cycles begin and end at rest.
using ProgramPart = std::variant<ChamberProtocol, HoldPart, LoopsPart, RestPart>;

/// What the chamber does, part after part. Each part starts at the pressure where the one before ended.
using ChamberProgram = std::vector<ProgramPart>;

}  // namespace fsr::simulation
