#include "ros/live/live_calibration.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class MaskFile : public test_support::FolderTest {
 protected:
  const std::string path = folder_ / "new" / "mask.yaml";
};

TEST_F(MaskFile, IsReadAsItWasWritten) {
  EXPECT_TRUE(loadMask(path).empty());
  const std::vector<std::uint8_t> mask = {0, 1, 1, 0};
  saveMask(mask, path);
  EXPECT_EQ(loadMask(path), mask);
  saveMask({}, path);
  EXPECT_TRUE(loadMask(path).empty());
}

TEST_F(MaskFile, NeitherReadsNorReplacesAnotherFile) {
  fs::create_directories(folder_ / "new");
  for (const char* const content : {"format: fsr_pressure_map tare 1\n", "#ROSBAG V2.0\nprecious"}) {
    std::ofstream(path) << content;
    EXPECT_THROW(loadMask(path), fsr::settings::InputError);
    EXPECT_THROW(saveMask({1}, path), fsr::settings::InputError);
    EXPECT_EQ(fs::file_size(path), std::strlen(content));
  }
}

TEST_F(MaskFile, AnEmptyPathStandsForNoFile) {
  saveMask({1}, "");
  EXPECT_TRUE(loadMask("").empty());
}

}  // namespace
}  // namespace fsr_ros
