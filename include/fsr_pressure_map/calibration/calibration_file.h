#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

// A calibration on disk: HDF5 (h5dump, h5py, MATLAB and R read it) behind a user block of 512 bytes,
// one line of text:
//
//     fsr_pressure_map calibration schema=2 sha256=<64 hex digits of all that follows byte 512>
//
// The hash is verified before HDF5 sees a byte: HDF5's own checksums let damage through.

/// What to read of a file: the sums behind a table are many times what a node needs.
enum class CalibrationParts { kWithoutStatistics, kAll };

/// Writes to a temporary name beside `path`, syncs, and renames: at `path` there is the old file or
/// the whole new one. Returns the id. Throws InputError where `path` cannot be written.
std::string saveCalibration(const Calibration& calibration, const std::string& path);

/// `regressors` knows the options of the model in the file; null = the regressors of this package. A table
/// must outlive the calibration. Throws InputError: one sentence that names the file and what is wrong with
/// it.
Calibration loadCalibration(const std::string& path,
                            CalibrationParts parts = CalibrationParts::kWithoutStatistics,
                            const regression::RegressorTable* regressors = nullptr);

}  // namespace fsr::calibration
