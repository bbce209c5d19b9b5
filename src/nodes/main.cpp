// CMake makes an executable of this file for each node, and defines FSR_NODE, its name.
#include <string>

namespace fsr_ros {
int nodeMain(const std::string& name, int argc, char** argv);  // in nodes.cpp
}

int main(int argc, char** argv) {
  return fsr_ros::nodeMain(FSR_NODE, argc, argv);
}
