#include "ros/tools/tools.h"

#include <fsr_pressure_map/MatrixInfo.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/source_dir.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

using test_support::holds;

namespace fs = std::filesystem;

const std::string kMeasured = test_support::sourceDir() + "/test/data/measured/";

class CsvToBag : public test_support::FolderTest {
 protected:
  void SetUp() override { bag_ = (folder_ / "table.bag").string(); }

  void run(std::vector<std::string> words) {
    words.insert(words.end(), {"--output", bag_});
    const test_support::ToolRun run = test_support::runTool(csvToBagTool, "csv_to_bag", words);
    said_ = run.said();
    EXPECT_EQ(run.status, run.error.empty() ? 0 : -1);
  }
  fsr_pressure_map::MatrixInfo matrixInfo() const {
    const rosbag::Bag bag(bag_);
    rosbag::View view(bag, rosbag::TopicQuery("/fsr/matrix_info"));
    return *view.begin()->instantiate<fsr_pressure_map::MatrixInfo>();
  }
  static std::pair<double, double> range(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high};
  }

  std::string bag_;
  std::string said_;
};

TEST_F(CsvToBag, ConvertsForceAgainstPositionOfAPiston) {
  run({kMeasured + "piston_o_ring_3bar.txt.gz", "--columns", "time=1:ms,reading=4:V,reference=5:10000Pa",
       "--range", "0,10", "--curvature", "0", "--surface", "flat"});
  const fsr::dataset::Recording recording = readBag(bag_);
  // zcat piston_o_ring_3bar.txt.gz | awk: 6340 rows, 65.697 s; column 5 -3.333 to 37.722, column 4 3.175
  // to 3.596
  EXPECT_EQ(recording.scans(), 6340u);
  EXPECT_NEAR(recording.time.back(), 65.697, 1e-6);
  EXPECT_EQ(recording.layout.size, (fsr::matrix::MatrixSize{1, 1}));
  EXPECT_NEAR(range(recording.pressure).first, -33330, 1e-3);
  EXPECT_NEAR(range(recording.pressure).second, 377220, 1e-3);
  const auto [least, most] = std::minmax_element(recording.counts.begin(), recording.counts.end());
  EXPECT_EQ(*least, 20807);  // 65535 * 0.3175
  EXPECT_EQ(*most, 23566);   // 65535 * 0.3596
  EXPECT_EQ(recording.conditions.at(0).name, "flat");
  EXPECT_EQ(matrixInfo().reference_voltage, 10.0f);
  EXPECT_EQ(matrixInfo().sensor_model, "65535 counts = 10 V");
}

TEST_F(CsvToBag, ConvertsTwoChambersAgainstForce) {
  run({kMeasured + "fluid_air_4hz.csv.gz", "--columns",
       "time=time_s,reading=pressure_left_V:V,reading=pressure_right_V:V,reference=force_N:N", "--area",
       "2e-5"});
  const fsr::dataset::Recording recording = readBag(bag_);
  EXPECT_EQ(recording.scans(), 10400u);
  EXPECT_EQ(recording.layout.size, (fsr::matrix::MatrixSize{1, 2}));
  EXPECT_NEAR(range(recording.pressure).second, 12.51942 / 2e-5, 1e-3);
  EXPECT_NE(said_.find("reference = force / 2e-05 m^2 (--area)"), std::string::npos) << said_;
  EXPECT_EQ(matrixInfo().reference_voltage, 5.0f);
  EXPECT_TRUE(holds(said_, {"10400 scans of 1 x 2 taxels", "65535 counts = 5 V"}));
}

TEST_F(CsvToBag, KeepsEveryStepOfTheOilRecording) {
  run({kMeasured + "fluid_oil_20min.csv.gz", "--columns",
       "time=time_s,reading=pressure_left_V:V,reference=force_N:N", "--area", "5e-6", "--ambient", "99000"});
  const fsr::dataset::Recording recording = readBag(bag_);
  EXPECT_EQ(recording.scans(), 24000u);
  EXPECT_EQ(recording.losses.no_reference, 0u);
  EXPECT_NEAR(recording.pressure.at(0), 0.36411 / 5e-6, 1e-6);
  EXPECT_EQ(matrixInfo().ambient_pressure, 99000);
}

TEST_F(CsvToBag, StatesConductancesByTheReadOutsResistance) {
  std::ofstream(folder_ / "ohm.csv") << "0,1000\n0.1,500\n";
  run({(folder_ / "ohm.csv").string(), "--columns", "time=1,reading=2:ohm"});
  EXPECT_EQ(matrixInfo().feedback_resistance, 500.0f);  // full scale at 2 mS
}

TEST_F(CsvToBag, LeavesNoBagBehindAnErrorAndNamesIt) {
  std::ofstream(folder_ / "bad.csv") << "0,1\n0.1,x\n";
  const auto complaint = [&](const std::vector<std::string>& words) {
    run(words);
    return said_;
  };
  const std::string bad = (folder_ / "bad.csv").string();
  EXPECT_TRUE(holds(complaint({bad, "--columns", "time=1,reading=2:V"}), {"bad.csv, line 2, column 2"}));
  EXPECT_NE(complaint({bad}).find("--columns"), std::string::npos);
  EXPECT_TRUE(holds(complaint({bad, "--columns", "time=1,reading=2", "--range", "5"}), {"--range"}));
  EXPECT_TRUE(holds(complaint({bad, "--columns", "time=1,reading=2", "--matrix", "0x3"}), {"--matrix"}));
  EXPECT_TRUE(holds(complaint({bad, "--columns", "time=1,reading=2", "--separator", "dot"}), {"semicolon"}));
  EXPECT_FALSE(fs::exists(bag_));
}

}  // namespace
}  // namespace fsr_ros
