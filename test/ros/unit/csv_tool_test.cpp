#include "ros/tools/tools.h"

#include <fsr_pressure_map/MatrixInfo.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/source_dir.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

const std::string kMeasured = test_support::sourceDir() + "/test/data/measured/";

class CsvToBag : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("csv_" + std::to_string(::getpid()) + "_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    bag_ = (folder_ / "table.bag").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  void run(std::vector<std::string> words) {
    words.insert(words.begin(), "csv_to_bag");
    words.insert(words.end(), {"--output", bag_});
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    EXPECT_EQ(csvToBagTool(static_cast<int>(argv.size()), argv.data(), out_), 0);
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

  fs::path folder_;
  std::string bag_;
  std::ostringstream out_;
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
  EXPECT_NE(out_.str().find("reference = force / 2e-05 m^2 (--area)"), std::string::npos) << out_.str();
  EXPECT_EQ(matrixInfo().reference_voltage, 5.0f);
  EXPECT_NE(out_.str().find("10400 scans of 1 x 2 taxels"), std::string::npos) << out_.str();
  EXPECT_NE(out_.str().find("65535 counts = 5 V"), std::string::npos) << out_.str();
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
  const auto complaint = [&](std::vector<std::string> words) -> std::string {
    try {
      run(std::move(words));
    } catch (const fsr::settings::InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string bad = (folder_ / "bad.csv").string();
  EXPECT_NE(complaint({bad, "--columns", "time=1,reading=2:V"}).find("bad.csv, line 2, column 2"),
            std::string::npos);
  EXPECT_NE(complaint({bad}).find("--columns"), std::string::npos);
  EXPECT_NE(complaint({bad, "--columns", "time=1,reading=2", "--range", "5"}).find("--range"),
            std::string::npos);
  EXPECT_NE(complaint({bad, "--columns", "time=1,reading=2", "--matrix", "0x3"}).find("--matrix"),
            std::string::npos);
  EXPECT_NE(complaint({bad, "--columns", "time=1,reading=2", "--separator", "dot"}).find("semicolon"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(bag_));
}

}  // namespace
}  // namespace fsr_ros
