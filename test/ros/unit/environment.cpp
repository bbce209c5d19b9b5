// Where the package lies and where ROS may write, for every test of this executable, however it is started.
// (ctest's ENVIRONMENT does not do: gtest_discover_tests passes on the first entry of a list alone.)

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

class RosEnvironment : public testing::Environment {
 public:
  void SetUp() override {
    ::setenv("ROS_PACKAGE_PATH", FSR_SOURCE_DIR, 1);
    ::setenv("ROS_HOME", (testing::TempDir() + "fsr_unit_ros_home").c_str(), 1);
  }
};

const testing::Environment* const environment = testing::AddGlobalTestEnvironment(new RosEnvironment);

}  // namespace
