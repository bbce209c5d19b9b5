#pragma once

#include <string>
#include <vector>

namespace fsr_ros {

/// Draws figures by a script of the package: runs `/usr/bin/python3 <package>/scripts/figures/SCRIPT
/// ARGUMENT...` without a shell and waits for its end. The scripts read results that are already written and
/// compute nothing. Throws fsr::InputError, with the last line that the script printed, where it fails, and
/// where the package or python is not found.
void drawFigures(const std::string& script, const std::vector<std::string>& arguments);

/// The same for a script anywhere.
void runPython(const std::string& path, const std::vector<std::string>& arguments);

}  // namespace fsr_ros
