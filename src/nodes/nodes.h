#pragma once

#include <string>

namespace fsr_ros {

/// The main part of the node of this name, e.g. "driver". Returns its exit status.
int nodeMain(const std::string& name, int argc, char** argv);

}  // namespace fsr_ros
