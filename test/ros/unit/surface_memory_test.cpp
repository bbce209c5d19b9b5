#include "ros/bags/surface_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

const LaidOn kFlat{"flat", 1};
const LaidOn kCylinder{"cylinder_7cm", 2};

class SurfaceMemoryTest : public test_support::FolderTest {
 protected:
  const std::string path = folder_ / "new" / "surface.yaml";
};

TEST_F(SurfaceMemoryTest, ANodeThatWasToldNothingTakesTheLaunchFiles) {
  SurfaceMemory memory(path, kFlat);
  EXPECT_EQ(memory.start(), kFlat);
  EXPECT_EQ(memory.remark(), "");
  memory.end();
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(SurfaceMemoryTest, ANodeThatDiedGoesOnWithWhatItWasTold) {
  SurfaceMemory(path, kFlat).keep(kCylinder);
  const SurfaceMemory again(path, kFlat);
  EXPECT_EQ(again.start(), kCylinder);
  EXPECT_NE(again.remark().find("goes on with cylinder_7cm, mount 2"), std::string::npos) << again.remark();
  EXPECT_NE(again.remark().find("not with flat, mount 1"), std::string::npos) << again.remark();
}

TEST_F(SurfaceMemoryTest, ANodeThatWasStoppedTakesTheLaunchFilesAndSaysTheConflict) {
  SurfaceMemory memory(path, kFlat);
  memory.keep(kCylinder);
  memory.end();
  const SurfaceMemory again(path, kFlat);
  EXPECT_EQ(again.start(), kFlat);
  EXPECT_NE(again.remark().find("lay last on cylinder_7cm, mount 2"), std::string::npos) << again.remark();
}

TEST_F(SurfaceMemoryTest, AnotherLaunchIsBelievedAndTheConflictSaid) {
  SurfaceMemory(path, kFlat).keep(kCylinder);
  const SurfaceMemory again(path, {"cylinder_5cm", 3});
  EXPECT_EQ(again.start().surface, "cylinder_5cm");
  EXPECT_NE(again.remark().find("the launch file says cylinder_5cm, mount 3"), std::string::npos);
}

TEST_F(SurfaceMemoryTest, NothingButASurfaceMemoryIsReplaced) {
  const std::string bag = folder_ / "recording.bag";
  std::ofstream(bag) << "#ROSBAG V2.0\nprecious";
  SurfaceMemory memory(bag, kFlat);
  EXPECT_NE(memory.remark().find(bag), std::string::npos) << memory.remark();
  EXPECT_THROW(memory.keep(kCylinder), fsr::settings::InputError);
  EXPECT_THROW(memory.end(), fsr::settings::InputError);
  EXPECT_EQ(fs::file_size(bag), 21u);
}

TEST_F(SurfaceMemoryTest, ADamagedFileIsSaidAndNotUsed) {
  SurfaceMemory(path, kFlat).keep(kCylinder);
  std::ofstream(path) << "format: something else\n";
  const SurfaceMemory again(path, kFlat);
  EXPECT_EQ(again.start(), kFlat);
  EXPECT_NE(again.remark().find(path), std::string::npos) << again.remark();
}

}  // namespace
}  // namespace fsr_ros
