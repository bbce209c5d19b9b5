// CMake makes an executable of this file for each node, and defines FSR_NODE, its name.
#include "nodes/nodes.h"

int main(int argc, char** argv) {
  return fsr_ros::nodeMain(FSR_NODE, argc, argv);
}
