#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

// What the recordings of one matrix say together.

Provenance provenanceOf(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options);

/// What the first recording leaves empty may stand in another.
dataset::SensorIdentity identityOf(const std::vector<dataset::Recording>& recordings);

/// 1 = masked in any of them. One value for each of `taxels`.
std::vector<std::uint8_t> unionOfMasks(const std::vector<dataset::Recording>& recordings, std::size_t taxels);

/// Their warnings and those of their sections, each with the recording's name.
std::vector<std::string> warningsOf(const std::vector<dataset::Recording>& recordings,
                                    const std::vector<dataset::Sections>& sections);

}  // namespace fsr::calibration
