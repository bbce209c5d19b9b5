#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "settings/command_line.h"
#include "settings/replace_file.h"

namespace fsr_ros {

constexpr int kFiguresMissing = 3;  ///< exit status if only the figures could not be drawn

using ToolProgress = std::function<void(const std::string& step, double share)>;

/// Shows on stderr what a tool does, the share that is done, and the time left (settings::Progress). The line
/// is removed when the last copy of the function is destroyed.
ToolProgress toolProgress();

/// The option --threads; 0 = one for each core. Throws fsr::settings::InputError.
unsigned threadsOf(const fsr::settings::CommandLine& line);

using fsr::settings::fullPath;

/// Creates a folder if it does not exist, and returns its absolute path. Throws fsr::InputError if it cannot
/// be created.
std::string outputFolder(const std::string& path);

/// A word as a shell reads it.
std::string shellWord(const std::string& word);

/// Adds the options --namespace and --ambient of a tool that reads bags. Returns the line.
fsr::settings::CommandLine& addBagOptions(fsr::settings::CommandLine& line);

/// Adds the option --unit of the pressures that a tool prints. Returns the line.
fsr::settings::CommandLine& addUnitOption(fsr::settings::CommandLine& line);

/// Shows pressures in the unit of --unit, or in kPa. Throws fsr::settings::InputError.
void takeUnit(const fsr::settings::CommandLine& line);

/// How a tool reads bags: by its options --namespace and --ambient, the counts of long bags into a file.
/// Throws fsr::settings::InputError.
BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line);

/// The recordings of bags, one after another, with their progress. `whole`: with the scans near a change of
/// surface, too.
std::vector<fsr::dataset::Recording> readBags(const BagReadOptions& how, const std::vector<std::string>& bags,
                                              const ToolProgress& progress = toolProgress(),
                                              bool whole = false);

/// Draws figures with a script of the package (drawFigures()). Returns 0, or kFiguresMissing after a sentence
/// on `out`.
int figuresDrawn(const std::string& script, const std::vector<std::string>& arguments, std::ostream& out);

/// Bags by their paths. A folder stands for the bags in it, in the order of the numbers at the start of their
/// names: 2_bent.bag before 10_flat.bag. Throws fsr::settings::InputError for a folder without a bag.
std::vector<std::string> bagsIn(const std::vector<std::string>& paths);

/// Draws figures with a script of the package: runs `/usr/bin/python3 <package>/scripts/figures/SCRIPT
/// ARGUMENT...` without a shell and waits for its end. The scripts read results that are already written and
/// compute nothing. Throws fsr::InputError if the script fails, with the last line that it printed, or if the
/// package or python is not found.
void drawFigures(const std::string& script, const std::vector<std::string>& arguments);

/// Runs any Python script in the same way.
void runPython(const std::string& path, const std::vector<std::string>& arguments);

}  // namespace fsr_ros
