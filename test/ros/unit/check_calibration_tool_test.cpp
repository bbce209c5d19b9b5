#include "ros/tools/tools.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "check/life_rig.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "support/folder_test.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class CheckCalibrationTool : public test_support::FolderTest {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "bags"); }

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
  int run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(checkCalibrationTool, "check_calibration", words);
    said_ = run.said();
    return run.status;
  }
  bool says(const std::string& words) const { return said_.find(words) != std::string::npos; }

  std::string said_;
};

TEST_F(CheckCalibrationTool, ShowsWhenASheetLostSensitivityAndATaxel) {
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

TEST_F(CheckCalibrationTool, KeepsSheetsApart) {
  test_support::LifeRig rig;
  rig.weeks = 2;
  record("0042", rig);
  record("0043", rig);
  EXPECT_EQ(run({folder_.string()}), 0);
  EXPECT_TRUE(says("Sheet 0042: ") && says("Sheet 0043: ")) << said_;
  EXPECT_TRUE(says("2 recordings, 1 calibration"));
  EXPECT_TRUE(says("too few dates to tell more")) << said_;
}

TEST_F(CheckCalibrationTool, NamesWhatItCannotReadAndGoesOn) {
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

TEST_F(CheckCalibrationTool, RefusesAFolderWithNothingToShow) {
  EXPECT_EQ(run({folder_.string()}), -1);
  EXPECT_TRUE(says(": has no bag (.bag) and no calibration file (.h5), also not in its subfolders")) << said_;
  EXPECT_EQ(run({(folder_ / "none").string()}), -1);
  EXPECT_TRUE(says("none: ")) << said_;
  EXPECT_EQ(run({}), -1);
  EXPECT_TRUE(says("no CALIBRATION and BAG is given")) << said_;
  std::ofstream(folder_ / "broken.bag") << "no bag";
  EXPECT_EQ(run({folder_.string()}), -1);
  EXPECT_TRUE(says(": none of its files could be used: broken.bag")) << said_;
  EXPECT_EQ(run({folder_.string(), "--level", "2"}), -1);
}

// A sheet on one surface, and a calibration of it.
class CheckOnBags : public CheckCalibrationTool {
 protected:
  void SetUp() override {
    CheckCalibrationTool::SetUp();
    fsr::calibration::CalibrationProblem problem{{recorded("cylinder_7cm", 14.25)}, {}};
    problem.options.scores = problem.options.choose_bandwidth = false;
    problem.options.regressor.grnn.bandwidth = 0.05;
    fsr::calibration::saveCalibration(fsr::calibration::calibrate(problem), sheet_);
    writeBag(same_, problem.recordings.front());
  }

  static fsr::dataset::Recording recorded(const std::string& surface, double curvature) {
    test_support::SyntheticRig rig;
    rig.surfaces = {{surface, curvature}};
    fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = 1500000000000000000;
    return recording;
  }

  const std::string sheet_ = path("sheet.h5"), same_ = path("same.bag");
};

TEST_F(CheckOnBags, SaysWhetherTheCalibrationIsStillGood) {
  EXPECT_EQ(run({sheet_, same_}), 0);
  EXPECT_TRUE(says("cylinder_7cm") && says("Still good.")) << said_;
  writeBag(path("flat.bag"), recorded("flat", 0));
  EXPECT_EQ(run({sheet_, path("flat.bag")}), 0);
  EXPECT_TRUE(says("Recalibrate, because")) << said_;
  EXPECT_EQ(run({sheet_, same_, "--output", path("child.h5")}), -1);
  EXPECT_TRUE(says("--output is of --correct, which is not given")) << said_;
  EXPECT_EQ(run({sheet_, same_, "--level", "0.1"}), -1);
  EXPECT_TRUE(says("--level is for the life of a sheet")) << said_;
}

TEST_F(CheckOnBags, CorrectsAWornSheetOnce) {
  const std::string child = path("child.h5"), report = path("check.json"), bag = path("worn.bag");
  run({sheet_, same_, "--correct", "--output", child});
  EXPECT_TRUE(says("\nStill good: ")) << said_;
  EXPECT_TRUE(says("; expected RMSE of the map ") && says(" kPa, of the tables alone ")) << said_;
  EXPECT_TRUE(says("No calibration was written to " + child)) << said_;
  EXPECT_FALSE(fs::exists(child));
  fsr::dataset::Recording worn = recorded("cylinder_7cm", 14.25);
  for (std::uint16_t& count : worn.counts) count = static_cast<std::uint16_t>(0.9 * count + 30);
  writeBag(bag, worn);
  run({sheet_, bag, "--correct", "--output", child});
  EXPECT_TRUE(says("\nCannot tell: ")) << said_;  // wear, or the new mount
  EXPECT_FALSE(fs::exists(child));
  run({sheet_, bag, "--correct", "--same-mount", "--output", child, "--report", report});
  const fsr::calibration::Calibration parent = fsr::calibration::loadCalibration(sheet_);
  const fsr::calibration::Calibration corrected = fsr::calibration::loadCalibration(child);
  EXPECT_TRUE(says("\nCorrected: on cycles that were left out")) << said_;
  EXPECT_TRUE(says("Calibration " + corrected.id + " (corrected on ")) << said_;
  EXPECT_EQ(corrected.correction.parent, parent.id);
  ASSERT_EQ(corrected.correction.bags.size(), 1u);
  EXPECT_EQ(corrected.correction.bags[0].name, "worn.bag");
  EXPECT_EQ(corrected.correction.bags[0].sha256.size(), 64u);
  std::ifstream file(report);
  const nlohmann::json json = nlohmann::json::parse(file);
  EXPECT_EQ(json["verdict"], "corrected");
  EXPECT_EQ(json["child"], corrected.id);
  EXPECT_EQ(json["rmse_pa"].size(), 6u);
  EXPECT_EQ(run({child, bag, "--correct"}), -1);
  EXPECT_TRUE(says("calibration " + corrected.id + " is itself a correction of " + parent.id)) << said_;
}

}  // namespace
}  // namespace fsr_ros
