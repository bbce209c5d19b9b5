// Sets the path of the package and the folder that ROS may write to, for all tests of this executable.
// (ctest's ENVIRONMENT cannot be used: gtest_discover_tests passes on only the first entry of a list.)

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/source_dir.h"

namespace {

class RosEnvironment : public testing::Environment {
 public:
  void SetUp() override {
    ::setenv("ROS_PACKAGE_PATH", test_support::sourceDir().c_str(), 1);
    ::setenv("ROS_HOME", home_.c_str(), 1);
  }
  void TearDown() override { std::filesystem::remove_all(home_); }

 private:
  std::string home_ = testing::TempDir() + "unit_ros_home_" + std::to_string(::getpid());
};

const testing::Environment* const environment = testing::AddGlobalTestEnvironment(new RosEnvironment);

}  // namespace
