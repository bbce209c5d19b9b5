#pragma once

#include <string>
#include <vector>

namespace fsr_ros {

/// Draws figures with a script of the package: runs `/usr/bin/python3 <package>/scripts/figures/SCRIPT
/// ARGUMENT...` without a shell and waits for its end. The scripts read results that are already written and
/// compute nothing. Throws fsr::InputError if the script fails, with the last line that it printed, or if the
/// package or python is not found.
void drawFigures(const std::string& script, const std::vector<std::string>& arguments);

/// Runs any Python script in the same way.
void runPython(const std::string& path, const std::vector<std::string>& arguments);

}  // namespace fsr_ros
