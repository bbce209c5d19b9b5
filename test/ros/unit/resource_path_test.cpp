#include "ros/bags/resource_path.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/source_dir.h"

namespace fsr_ros {
namespace {

class ResourcePath : public testing::Test {
 protected:
  void SetUp() override {
    setenv("ROS_HOME", "/var/ros", 1);
    setenv("HOME", "/home/rig", 1);
    setenv("ROS_PACKAGE_PATH", test_support::sourceDir().c_str(), 1);
  }
};

TEST_F(ResourcePath, DoesNotChangeAnAbsoluteOrEmptyPath) {
  EXPECT_EQ(resolveResource("/data/a b.h5"), "/data/a b.h5");
  EXPECT_EQ(resolveResource("file:///data/a.h5"), "/data/a.h5");
  EXPECT_EQ(resolveResource(""), "");
}

TEST_F(ResourcePath, KnowsTheHomeOfRosAndOfTheUser) {
  EXPECT_EQ(resolveResource("${ROS_HOME}/c.h5"), "/var/ros/c.h5");
  EXPECT_EQ(resolveResource("~/c.h5"), "/home/rig/c.h5");
  unsetenv("ROS_HOME");
  EXPECT_EQ(resolveResource("file://${ROS_HOME}/c.h5"), "/home/rig/.ros/c.h5");
}

TEST_F(ResourcePath, FindsAFileOfAPackage) {
  const std::string path = resolveResource("package://fsr_pressure_map/package.xml");
  EXPECT_TRUE(std::filesystem::equivalent(path, test_support::sourceDir() + "/package.xml")) << path;
}

TEST_F(ResourcePath, RefusesRelativePathsAndUnknownSchemes) {
  for (const char* text : {"c.h5", "../c.h5", "http://rig/c.h5", "${HOME}/c.h5",
                           "package://no_such_package/c", "package:///c"}) {
    EXPECT_THROW(resolveResource(text), fsr::settings::InputError) << text;
  }
}

TEST_F(ResourcePath, ARelativePathOfALaunchFileStartsWhereTheUserCalledIt) {
  setenv("PWD", "/data/monday", 1);
  EXPECT_EQ(resolveLaunchPath("c.h5"), "/data/monday/c.h5");
  EXPECT_EQ(resolveLaunchPath("/c.h5"), "/c.h5");
  EXPECT_EQ(resolveLaunchPath("~/c.h5"), "/home/rig/c.h5");
  EXPECT_EQ(resolveLaunchPath(""), "");
  EXPECT_THROW(resolveLaunchPath("http://rig/c.h5"), fsr::settings::InputError);
}

}  // namespace
}  // namespace fsr_ros
