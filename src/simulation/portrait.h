#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// A line of a figure.
struct PortraitLine {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
};

/// Data of a figure that shows the effects of a rig: the same four experiments with them and without.
/// Readings are unrounded, without noise, in shares of full scale.
struct Portrait {
  std::string title;
  /// Reading by recorded pressure [Pa], first loading, flat and bent; all else is bent.
  std::vector<PortraitLine> response;
  std::vector<PortraitLine> loop;   ///< change of the reading by pressure [Pa], slow cycles, then a fast one
  std::vector<PortraitLine> hold;   ///< change of the reading by time [s]: step, hold, vent, rest
  PortraitLine hold_pressure;       ///< the chamber's pressure [Pa] then
  matrix::MatrixSize size;          ///< of the maps, which are [rows x columns], row-major
  std::vector<double> disc;         ///< readings under a disc
  std::vector<double> disc_change;  ///< largest change of the readings while it is pressed on
  std::vector<double> gas_change;   ///< the same under gas alone
};

/// The settings with an effect enabled at its usual values; unchanged where it is enabled already. Throws
/// InputError where there is no such effect.
SimulationSettings withEffect(const SimulationSettings& settings, const std::string& id);
SimulationSettings withoutEffect(const SimulationSettings& settings, const std::string& id);
/// The settings with those effects only that the simplest simulation of a bent sensor has, as in core.yaml.
SimulationSettings coreOf(const SimulationSettings& settings);

/// Both must be of one matrix. Throws InputError.
Portrait portray(const SimulationSettings& with, const SimulationSettings& without);

}  // namespace fsr::simulation
