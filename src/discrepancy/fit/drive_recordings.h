#pragma once

#include <functional>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "simulation/driven_rig.h"

namespace fsr::discrepancy {

/// Drives a simulation through recordings as `simulate --drive` does: without white noise, at every scan,
/// with the matrix and the full scale of the first recording, and with the state kept from one recording to
/// the next. `recordings` are in order of time. A recording that begins before the last one ended starts with
/// a new sheet (bags that were converted from tables may all begin at the same date). `use` gets the place of
/// the recording, the scan, and the chain after that scan.
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

}  // namespace fsr::discrepancy
