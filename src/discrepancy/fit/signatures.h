#pragma once

#include <functional>
#include <string>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "simulation/effects/effect_library.h"
#include "simulation/rig.h"

namespace fsr::discrepancy {

/// Drives a simulation through recordings as `simulate --gap` does: without noise and whatever else is
/// random, at every scan, with the matrix and the full scale of the first recording, and with the state kept
/// from one recording to the next. `recordings` are in order of time. A recording that begins before the last
/// one ended starts with a new sheet (bags that were converted from tables may all begin at the same date).
/// `use` gets the place of the recording, the scan, and the chain after that scan.
void driveRecordings(const std::vector<const dataset::Recording*>& recordings,
                     const simulation::SimulationSettings& simulation,
                     const std::function<void(std::size_t recording, std::size_t scan,
                                              const simulation::SensorChain& chain)>& use);

/// Drives two simulations through the same recordings. `use` gets the readings of the first [counts] and the
/// chain of the second after each scan.
void driveRecordingsTwice(
    const std::vector<const dataset::Recording*>& recordings, const simulation::SimulationSettings& first,
    const simulation::SimulationSettings& second,
    const std::function<void(std::size_t recording, std::size_t scan, const double* first,
                             const simulation::SensorChain& second)>& use);

/// What one strength of one effect, with certain values of its shapes, would add to the common trace.
struct Signature {
  std::string id;
  std::string strength;
  simulation::EffectValues values;  ///< of all parameters except the strength
  bool state_kept = true;           ///< the state outlasts a new mounting; else each mounting starts afresh
  bool free_sign = false;
  double scale = 1;  ///< strength per unit of `trace`; its sign follows the effect's sign rule
  /// Strength at which the change of the reading is taken and divided by the strength; 0 = the derivative at
  /// strength 0. A change of load that is as large as the load itself is not linear in the reading.
  double amplitude = 0;
  Trace trace;  ///< scaled to rms 1 [-]
};

/// The surface of one taxel: the mean over those of all taxels.
matrix::Surface oneTaxel(const matrix::Surface& surface);

/// Settings of a simulation of one taxel in the middle of the scatter: 1 x 1, no noise.
simulation::SimulationSettings representative(const simulation::SimulationSettings& settings);

/// The time course of a chain's signals under the recorded pressure, surfaces and temperature.
struct DrivenSignals {
  Trace load;     ///< [Pa]
  Trace gain;     ///< factor
  Trace reading;  ///< [share of full scale]
};

/// The derivative of all signals with respect to one strength.
DrivenSignals drivenDerivative(const Measured& measured, const simulation::SimulationSettings& settings,
                               const std::string& id, const std::string& strength,
                               const simulation::EffectValues& values, bool state_kept);

/// The signals of a chain.
DrivenSignals driven(const Measured& measured, const simulation::SimulationSettings& settings);

/// Converts a change of load and gain into a change of the common trace, by the rise of the measured static
/// curves and, for `amplitude` 0, by their slope. Otherwise the load changes by `amplitude` times the
/// derivative, and the result is divided by it. From the conductance stage on it returns the change of the
/// reading itself.
Trace throughCurve(const Measured& measured, const StaticFit& fit, const DrivenSignals& derivative,
                   simulation::ChainStage stage, double amplitude);

/// Whether the user lets an effect be found: `settings` does not enable it, and it is not left out.
bool mayBeFound(const std::string& id, const simulation::SimulationSettings& settings,
                const std::vector<std::string>& leave_out);

/// Returns the signatures of all effects that `settings` does not enable and that act on all taxels alike,
/// for each combination of the shapes' tried values, in the library's order. An effect with memory appears
/// twice: with its state carried over between visits, and with each visit starting afresh.
std::vector<Signature> signatures(const Measured& measured, const StaticFit& fit,
                                  const simulation::SimulationSettings& settings,
                                  const std::vector<std::string>& leave_out, unsigned threads);

}  // namespace fsr::discrepancy
