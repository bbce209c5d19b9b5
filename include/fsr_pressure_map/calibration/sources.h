#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/dataset/sections.h"

namespace fsr {

// What the recordings of one matrix say together.

Provenance provenanceOf(const std::vector<Recording>& recordings, const CalibrationOptions& options);

/// What the first recording leaves empty may stand in another.
SensorIdentity identityOf(const std::vector<Recording>& recordings);

/// 1 = masked in any of them. One value for each of `taxels`.
std::vector<std::uint8_t> unionOfMasks(const std::vector<Recording>& recordings, std::size_t taxels);

/// Their warnings and those of their sections, each with the recording's name.
std::vector<std::string> warningsOf(const std::vector<Recording>& recordings,
                                    const std::vector<Sections>& sections);

}  // namespace fsr
