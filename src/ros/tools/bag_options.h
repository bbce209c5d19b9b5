#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "settings/command_line.h"

namespace fsr_ros {

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
