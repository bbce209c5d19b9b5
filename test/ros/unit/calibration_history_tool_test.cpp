#include "ros/tools/calibration_history_tool.h"

#include <unistd.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "life/life_rig.h"
#include "ros/bags/bag_writer.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class CalibrationHistoryTool : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("history_" + std::to_string(::getpid()) + "_" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "bags");
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A bag a week, and a calibration of the first one.
  void record(const std::string& serial, const test_support::LifeRig& rig) const {
    std::vector<fsr::dataset::Recording> recordings = test_support::weeklyRecordings(rig);
    for (std::size_t week = 0; week < recordings.size(); ++week) {
      recordings[week].sensor.serial = serial;
      // This board has no noise on an open circuit.
      for (std::size_t i = rig.dead_taxel; i < recordings[week].counts.size() && week >= rig.dead_from;
           i += 12)
        recordings[week].counts[i] = 0;
      const fs::path day = folder_ / "bags" / ("week_" + std::to_string(week));
      fs::create_directories(day);
      writeBag((day / (serial + ".bag")).string(), recordings[week]);
    }
    fsr::calibration::Calibration first = test_support::lineThrough(recordings.front());
    first.provenance.date = "2024-01-01T12:00:00Z";
    fsr::calibration::saveCalibration(first, (folder_ / (serial + ".h5")).string());
  }

  // Returns the exit status, or -1 after an InputError; the output or the message is in said_.
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "calibration_history");
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    std::ostringstream out;
    try {
      const int status = calibrationHistoryTool(static_cast<int>(arguments.size()), arguments.data(), out);
      said_ = out.str();
      return status;
    } catch (const fsr::settings::InputError& error) {
      said_ = error.what();
      return -1;
    }
  }
  bool says(const std::string& words) const { return said_.find(words) != std::string::npos; }

  fs::path folder_;
  std::string said_;
};

TEST_F(CalibrationHistoryTool, ShowsWhenASheetLostSensitivityAndATaxel) {
  test_support::LifeRig rig;
  rig.weeks = 12;
  rig.gain = [](std::size_t week) { return week < 9 ? 1.0 : 0.8; };
  rig.dead_taxel = 6;
  rig.dead_from = 10;
  record("0042", rig);
  const std::string output = (folder_ / "life").string();
  EXPECT_EQ(run({folder_.string(), "--output", output, "--no-figures"}), 0) << said_;
  EXPECT_TRUE(says("Sheet 0042: 2024-01-01 to 2024-03-")) << said_;
  EXPECT_TRUE(says("12 recordings, 1 calibration")) << said_;
  EXPECT_TRUE(says("slope against 0042.h5")) << said_;
  EXPECT_TRUE(says("  2024-03-04: gain of the recordings is 0.")) << said_;
  EXPECT_TRUE(says("  2024-03-11: taxel (row, column) (1, 2) is dead; before it was not\n")) << said_;
  std::ifstream file(output + "/life.json");
  const nlohmann::json life = nlohmann::json::parse(file);
  ASSERT_EQ(life["sheets"].size(), 1u);
  EXPECT_EQ(life["sheets"][0]["sheet"], "0042");
  EXPECT_NEAR(life["sheets"][0]["rows"].back()["gain"].get<double>(), 0.8, 0.05) << "without the dead taxel";
  EXPECT_EQ(life["sheets"][0]["lost_taxels"][0]["column"], 2);
  std::ifstream table(output + "/life.csv");
  std::string head;
  std::getline(table, head);
  EXPECT_EQ(head.find("sheet,date,source,files,gain [1],"), 0u);
}

TEST_F(CalibrationHistoryTool, KeepsSheetsApart) {
  test_support::LifeRig rig;
  rig.weeks = 2;
  record("0042", rig);
  record("0043", rig);
  EXPECT_EQ(run({folder_.string()}), 0);
  EXPECT_TRUE(says("Sheet 0042: ") && says("Sheet 0043: ")) << said_;
  EXPECT_TRUE(says("2 recordings, 1 calibration"));
  EXPECT_TRUE(says("too few dates to tell more")) << said_;
}

TEST_F(CalibrationHistoryTool, NamesWhatItCannotReadAndGoesOn) {
  test_support::LifeRig rig;
  rig.weeks = 1;
  record("0042", rig);
  std::ofstream(folder_ / "bags" / "broken.bag") << "no bag";
  std::ofstream(folder_ / "broken.h5") << "no calibration";
  EXPECT_EQ(run({folder_.string()}), 1);
  EXPECT_TRUE(says("Sheet 0042: ")) << said_;
  EXPECT_TRUE(says("Not used: bags/broken.bag: ")) << said_;
  EXPECT_TRUE(says("Not used: broken.h5: ")) << said_;
}

TEST_F(CalibrationHistoryTool, RefusesAFolderWithNothingToShow) {
  EXPECT_EQ(run({folder_.string()}), -1);
  EXPECT_TRUE(says(": has no bag (.bag) and no calibration file (.h5), also not in its subfolders")) << said_;
  EXPECT_EQ(run({(folder_ / "none").string()}), -1);
  EXPECT_TRUE(says(": there is no such folder"));
  EXPECT_EQ(run({}), -1);
  EXPECT_TRUE(says("no DIR is given"));
  std::ofstream(folder_ / "broken.bag") << "no bag";
  EXPECT_EQ(run({folder_.string()}), -1);
  EXPECT_TRUE(says(": none of its files could be used: broken.bag")) << said_;
  EXPECT_EQ(run({folder_.string(), "--level", "2"}), -1);
}

}  // namespace
}  // namespace fsr_ros
