#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// validate() of a problem of these parts, for recordings that are not copied into one.
void validate(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options);

/// Throws InputError if the recording has another matrix or converter than the calibration.
void requireMatrix(const Calibration& calibration, const dataset::Recording& recording);

/// Throws InputError if the recording has no chamber pressure, or another matrix or converter than the
/// calibration.
void requireFit(const Calibration& calibration, const dataset::Recording& recording);

// Information that is combined from all recordings of one matrix.

Provenance provenanceOf(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options);

/// Fields that are empty in the first recording are taken from the next one that has them.
dataset::SensorIdentity identityOf(const std::vector<dataset::Recording>& recordings);

/// [taxels], 1 = masked in any recording.
std::vector<std::uint8_t> unionOfMasks(const std::vector<dataset::Recording>& recordings, std::size_t taxels);

/// The warnings of the recordings and of their sections, each with the name of the recording.
std::vector<std::string> warningsOf(const std::vector<dataset::Recording>& recordings,
                                    const std::vector<dataset::Sections>& sections);

}  // namespace fsr::calibration
