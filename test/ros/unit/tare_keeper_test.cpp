#include "ros/live/live_calibration.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class TareKeeperTest : public test_support::FolderTest {
 protected:
  void SetUp() override {
    tare.calibration = "id";
    tare.surface = "flat";
    tare.mount = 3;
    tare.size = {1, 2};
    tare.offset = {10.0f, 20.0f};
    flat = {"flat", 3, {{}}, {}};
    TareKeeper::write(tare, path);
  }

  const std::string path = folder_ / "new" / "folder" / "tare.yaml";
  fsr::calibration::Tare tare;
  fsr::matrix::Surface flat;
};

TEST_F(TareKeeperTest, ReadsTheTareOfAnEarlierRun) {
  TareKeeper keeper(path);
  EXPECT_EQ(keeper.review("id", &flat), tare.offset);
}

TEST_F(TareKeeperTest, WaitsForCalibrationAndCurvature) {
  TareKeeper keeper(path);
  EXPECT_TRUE(keeper.review("", &flat).empty());
  EXPECT_TRUE(keeper.review("id", nullptr).empty());
  EXPECT_TRUE(keeper.tare().has_value());
  EXPECT_EQ(keeper.review("id", &flat), tare.offset);
}

TEST_F(TareKeeperTest, NeedsNoCurvatureIfItWasMeasuredWithoutOne) {
  tare.surface.clear();
  tare.mount = 0;
  TareKeeper::write(tare, path);
  TareKeeper keeper(path);
  EXPECT_EQ(keeper.review("id", nullptr), tare.offset);
}

TEST_F(TareKeeperTest, DropsTareAndFileOnAnotherMount) {
  TareKeeper keeper(path);
  flat.mount = 4;
  EXPECT_TRUE(keeper.review("id", &flat).empty());
  EXPECT_FALSE(keeper.tare().has_value());
  EXPECT_TRUE(fs::exists(path)) << "no scan waits for the disk";
  EXPECT_TRUE(keeper.takeDropped());
  EXPECT_FALSE(keeper.takeDropped()) << "its file is removed once";
}

TEST_F(TareKeeperTest, DropsItForAnotherCalibrationWithoutWaitingForCurvature) {
  TareKeeper keeper(path);
  EXPECT_TRUE(keeper.review("other", nullptr).empty());
  EXPECT_TRUE(keeper.takeDropped());
}

TEST_F(TareKeeperTest, ANewTareNeedsNoRemoval) {
  TareKeeper keeper(path);
  EXPECT_TRUE(keeper.drop());
  keeper.adopt(tare);
  EXPECT_FALSE(keeper.takeDropped());
}

TEST_F(TareKeeperTest, AnEmptyPathStandsForNoFile) {
  TareKeeper keeper("");
  EXPECT_FALSE(keeper.tare().has_value());
  TareKeeper::write(tare, "");
  EXPECT_FALSE(TareKeeper::remove(""));
}

TEST_F(TareKeeperTest, LeavesADamagedFileAlone) {
  std::ofstream(path) << "format: something";
  TareKeeper keeper(path);
  EXPECT_TRUE(keeper.review("id", &flat).empty());
  EXPECT_TRUE(fs::exists(path));
}

TEST_F(TareKeeperTest, RemovesNothingButATare) {
  const std::string bag = folder_ / "recording.bag";
  std::ofstream(bag) << "precious";
  EXPECT_THROW(TareKeeper::remove(bag), fsr::settings::InputError);
  EXPECT_THROW(TareKeeper::write(tare, bag), fsr::settings::InputError);
  EXPECT_EQ(fs::file_size(bag), 8u);
  fs::create_directory(folder_ / "empty");
  EXPECT_THROW(TareKeeper::remove(folder_ / "empty"), fsr::settings::InputError);
  EXPECT_TRUE(fs::exists(folder_ / "empty"));
}

TEST_F(TareKeeperTest, RemovesADamagedTare) {
  std::ofstream(path, std::ios::app) << "offset: twice";
  TareKeeper keeper(path);
  EXPECT_FALSE(keeper.tare().has_value());
  EXPECT_TRUE(TareKeeper::remove(path));
  EXPECT_FALSE(fs::exists(path));
  EXPECT_FALSE(TareKeeper::remove(path));
}

}  // namespace
}  // namespace fsr_ros
