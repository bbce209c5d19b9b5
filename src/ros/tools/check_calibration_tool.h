#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace fsr_ros {

/// `check_calibration CALIBRATION BAG...` says whether a calibration is still good; with --correct also
/// whether a correction of gain and offset is worth it, which is written to --output. `check_calibration DIR`
/// shows the life of each sheet: every bag and calibration file in a folder and its subfolders, by date, and
/// what changed suddenly; with --output it writes life.csv, life.json and figures.
/// Returns 0 whatever the verdict is; of a folder 1 if a file could not be used, 3 if only the figures are
/// missing. Throws fsr::InputError.
int checkCalibrationTool(int argc, const char* const* argv, std::ostream& out);

// Earlier names of this tool, for one version.

/// The words behind check_calibration for those of `train --check FILE BAG...` and `train --correct FILE
/// BAG...`; nothing for other words.
std::optional<std::vector<std::string>> wordsOfCheck(int argc, const char* const* argv);

/// Says that `earlier` is check_calibration now, and runs it with these words.
int checkInstead(const std::string& earlier, const std::vector<std::string>& words, std::ostream& out);

}  // namespace fsr_ros
