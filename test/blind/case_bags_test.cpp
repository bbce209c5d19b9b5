#include "blind/case_bags.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "fsr_pressure_map/ros/bag_reader.h"

namespace blind {
namespace {

namespace fs = std::filesystem;

class CaseBags : public testing::Test {
 protected:
  // A folder for each process: ctest runs the cases side by side.
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("blind_case_bags_" + std::to_string(getpid()));
  }
  void TearDown() override { fs::remove_all(folder_); }

  BlindCase written(const std::string& name) {
    CaseSpec spec;
    spec.name = name;
    spec.most_readings = 100e3;
    spec.judged = false;
    BlindCase made = makeCase(spec);
    writeCase(made, folder_.string());
    return made;
  }
  fs::path folder_;
};

TEST_F(CaseBags, AreReadBackByThePackage) {
  std::set<std::string> kinds;
  bool lost = false, without_thermometer = false;
  for (int i = 0; i < 14; ++i) {
    const BlindCase made = written("bags " + std::to_string(i));
    kinds.insert(made.plan->cut.kind);
    lost = lost || made.lost_scans > 0;
    without_thermometer = without_thermometer || !made.plan->thermometer;
    EXPECT_TRUE(fs::exists(folder_ / "key.yaml"));
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "bags"))
      files += entry.path().extension() == ".bag";
    EXPECT_EQ(files, made.bags.size());
    for (const CaseBag& bag : made.bags) {
      const fsr::dataset::Recording& truth = bag.recording;
      const fsr::dataset::Recording read = fsr_ros::readBag((folder_ / "bags" / truth.name).string());
      EXPECT_EQ(read.layout.size, truth.layout.size);
      EXPECT_EQ(read.full_scale, truth.full_scale);
      EXPECT_EQ(read.temperature.empty(), !made.plan->thermometer);
      ASSERT_FALSE(read.conditions.empty());
      EXPECT_EQ(read.conditions[0].name, truth.conditions[0].name);
      EXPECT_EQ(read.conditions[0].mount, truth.conditions[0].mount);
      // The reader drops scans near a change of surface; all others are there, with the same reference.
      EXPECT_GT(read.scans() + 1, 0.9 * static_cast<double>(truth.scans()));
      const double near = 0.1 * *std::max_element(truth.pressure.begin(), truth.pressure.end());  // [Pa]
      std::size_t at = 0, compared = 0;
      for (std::size_t scan = 0; scan < read.scans(); ++scan) {
        const double time = read.time[scan] + static_cast<double>(read.start_ns - truth.start_ns) * 1e-9;
        while (at < truth.scans() && truth.time[at] < time - 1e-6) ++at;
        ASSERT_LT(at, truth.scans());
        ASSERT_NEAR(truth.time[at], time, 1e-6);
        EXPECT_NEAR(read.pressure[scan], truth.pressure[at], near) << "linear there, a monotone cubic here";
        EXPECT_EQ(read.scan(scan)[0], truth.scan(at)[0]);
        ++compared;
      }
      EXPECT_GT(compared, 50u);
    }
  }
  EXPECT_EQ(kinds.size(), 3u);
  EXPECT_TRUE(lost);
  EXPECT_TRUE(without_thermometer);
}

TEST_F(CaseBags, OfAnEarlierCaseAreRemoved) {
  written("bags 1");
  const BlindCase made = written("bags 2");
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "bags"))
    files += entry.path().extension() == ".bag";
  EXPECT_EQ(files, made.bags.size());
}

}  // namespace
}  // namespace blind
