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

/// Reads a list of parts, each a mapping with one key:
///
///     - cycles: {peak: 620000, rate: 17000, ...}                      # see readChamberProtocol()
///     - hold: {pressure: 300000, rate: 100000, duration: 300}
///     - loops: {low: 200000, high: 400000, rate: 17000, loops: 4}
///     - rest: {rate: 17000, duration: 600}
///
/// Throws InputError that names what is missing or out of range, also where something follows cycles that
/// never end.
ChamberProgram readChamberProgram(const std::vector<settings::Settings>& parts);

PressureProfile pressureProfile(const ChamberProgram& program);

/// The part as readChamberProgram() reads it, on one line, without the leading dash.
std::string programText(const ProgramPart& part);

}  // namespace fsr::simulation
