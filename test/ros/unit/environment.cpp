// Sets the path of the package and the folder that ROS may write to, for all tests of this executable.
// (ctest's ENVIRONMENT cannot be used: gtest_discover_tests passes on only the first entry of a list.)

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/source_dir.h"

namespace {

class RosEnvironment : public testing::Environment {
 public:
  void SetUp() override {
    ::setenv("ROS_PACKAGE_PATH", test_support::sourceDir().c_str(), 1);
    ::setenv("ROS_HOME", (testing::TempDir() + "fsr_unit_ros_home").c_str(), 1);
  }
};

const testing::Environment* const environment = testing::AddGlobalTestEnvironment(new RosEnvironment);

}  // namespace
