#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

// A calibration file is HDF5 (readable with h5dump, h5py, MATLAB and R) after a user block of 512 bytes,
// which contains one line of text:
//
//     fsr_pressure_map calibration schema=2 sha256=<64 hex digits of all that follows byte 512>
//
// `schema` is the number of the file's format. The hash is verified before the HDF5 library reads the file,
// because the checksums of HDF5 do not detect all damage.

/// The parts to read. The sums behind the tables are much larger than what a node needs.
enum class CalibrationParts { kWithoutStatistics, kAll };

/// Writes to a temporary file beside `path`, syncs and renames it, so that `path` is always the old file or
/// the complete new one. Returns the id. Throws InputError if `path` cannot be written.
std::string saveCalibration(const Calibration& calibration, const std::string& path);

/// `regressors` knows the options of the model in the file; null = the regressors of this package. A table
/// must outlive the calibration. Throws InputError: one sentence that names the file and what is wrong with
/// it.
Calibration loadCalibration(const std::string& path,
                            CalibrationParts parts = CalibrationParts::kWithoutStatistics,
                            const regression::RegressorTable* regressors = nullptr);

}  // namespace fsr::calibration
