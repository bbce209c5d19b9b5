#pragma once

#include <functional>
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

/// How a tool reads bags: by its options --namespace and --ambient, the counts of long bags into a file.
/// Throws fsr::settings::InputError.
BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line);

/// The recordings of bags, one after another, with their progress on the terminal.
std::vector<fsr::dataset::Recording> readBags(const fsr::settings::CommandLine& line,
                                              const std::vector<std::string>& bags);

/// Bags by their paths. A folder stands for the bags in it, in the order of the numbers at the start of their
/// names: 2_bent.bag before 10_flat.bag. Throws fsr::settings::InputError for a folder without a bag.
std::vector<std::string> bagsIn(const std::vector<std::string>& paths);

}  // namespace fsr_ros
