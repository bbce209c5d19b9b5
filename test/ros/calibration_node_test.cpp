#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/LoadFile.h>
#include <fsr_pressure_map/SetMask.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Temperature.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "ros/bags/resource_path.h"
#include "support/calibration_rig.h"
#include "support/diagnostics.h"
#include "support/small_calibration.h"
#include "support/small_tables.h"

namespace {

namespace fs = std::filesystem;
using fsr_pressure_map::CalibrationInfo;
using fsr_pressure_map::PressureMap;
using test_support::CalibrationRig;
using test_support::knownDeviation;
using test_support::knownPressure;
using test_support::kRigFullScale;
using test_support::kRigTaxels;

const fs::path kFolder = fsr_ros::rosHome() + "/calibration_test";  // as in calibration.test; new in each run
const std::string kFile = kFolder / "calibration.h5";
const std::string kTareFile = kFolder / "tare.yaml";
const fsr::matrix::MatrixSize kSize{test_support::kRigRows, test_support::kRigColumns};

std::string save(const std::string& path, const std::vector<double>& curvatures) {
  return fsr::calibration::saveCalibration(test_support::smallCalibration(kSize, curvatures), path);
}

struct Reply {
  bool success = false;
  std::string message;
};

template <typename Service>
Reply replyOf(const std::string& name, const typename Service::Request& request = {}) {
  const auto response = test_support::call<Service>("calibration/" + name, request);
  return {response.success != 0, response.message};
}

Reply load(const std::string& path) {
  fsr_pressure_map::LoadFile::Request request;
  request.path = path;
  return replyOf<fsr_pressure_map::LoadFile>("load_calibration", request);
}

Reply trigger(const std::string& service) {
  return replyOf<std_srvs::Trigger>(service);
}

Reply mask(const std::vector<std::uint8_t>& taxels) {
  fsr_pressure_map::SetMask::Request request;
  request.mask = taxels;
  return replyOf<fsr_pressure_map::SetMask>("set_mask", request);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Every test starts with a flat surface, the right board, no mask and no tare.
class CalibrationNode : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::remove_all(kFolder);
    fs::create_directories(kFolder);
  }

  void SetUp() override {
    ASSERT_TRUE(rig.connected());
    if (!fs::exists(kFile)) return;
    ASSERT_TRUE(load(kFile).success);
    ASSERT_TRUE(mask({}).success);
    rig.identify("board-1");
    // Another surface in between, because a map of the flat surface may belong to the previous mount.
    rig.lieOn({15.0f}, "bent", ++mount);
    reach([](const PressureMap& map) { return map.flags[0] & PressureMap::FLAG_BETWEEN_CLASSES; });
    rig.lieOn({0.0f}, "flat", ++mount);
    trigger("clear_tare");
    reach([](const PressureMap& map) { return map.state == PressureMap::STATE_OK && map.flags[0] == 0; });
  }

  /// Publishes scans until a map fulfils a condition.
  PressureMap reach(const std::function<bool(const PressureMap&)>& wanted, std::uint16_t code = 500) {
    const auto whole = [&](const PressureMap& map) { return map.flags.size() == kRigTaxels && wanted(map); };
    const PressureMap map = rig.mapWhen(code, whole);
    EXPECT_TRUE(whole(map)) << "state " << int(map.state);
    return map;
  }

  /// Calls a service of the node while scans of `code` are published with stamps 0.1 s apart.
  Reply whileScanning(
      const std::function<Reply()>& service,
      const std::function<std::uint16_t(int)>& code = [](int) { return std::uint16_t{50}; }) {
    std::future<Reply> reply = std::async(std::launch::async, service);
    for (int i = 0; reply.wait_for(std::chrono::seconds(0)) != std::future_status::ready; ++i) {
      rig.mapOf(code(i));
    }
    return reply.get();
  }

  static std::uint32_t mount;
  CalibrationRig rig;
};

std::uint32_t CalibrationNode::mount = 0;

TEST_F(CalibrationNode, PublishesEmptyMapsUntilItHasACalibration) {
  const PressureMap map = rig.mapOf(500);
  EXPECT_EQ(map.state, PressureMap::STATE_UNCALIBRATED);
  EXPECT_EQ(map.header.frame_id, "sheet");
  ASSERT_EQ(map.pressure.size(), kRigTaxels);
  for (const float pressure : map.pressure) EXPECT_TRUE(std::isnan(pressure));
  const auto info = ros::topic::waitForMessage<CalibrationInfo>("calibration_info", ros::Duration(30));
  ASSERT_TRUE(info);
  EXPECT_EQ(info->id, "");
}

TEST_F(CalibrationNode, LoadsItsFileAsSoonAsItExists) {
  const std::string id = save(kFile, {0.0, 10.0, 20.0});
  const PressureMap map =
      reach([](const PressureMap& m) { return m.state != PressureMap::STATE_UNCALIBRATED; });
  EXPECT_EQ(map.state, PressureMap::STATE_CURVATURE_UNKNOWN);
  EXPECT_EQ(map.pressure[3], knownPressure(3, 0, 500));  // the flattest trained surface
  EXPECT_EQ(map.calibration, id);
  EXPECT_EQ(map.scheme, "per_curvature");
}

TEST_F(CalibrationNode, GivesTheTablesValuesExactly) {
  rig.lieOn({10.0f});
  reach([](const PressureMap& m) { return m.pressure[0] == knownPressure(0, 1, 500); });
  std::vector<std::uint16_t> counts;
  for (std::size_t taxel = 0; taxel < kRigTaxels; ++taxel) counts.push_back(std::uint16_t(100 + 50 * taxel));
  const PressureMap map = rig.mapOf(rig.scan(counts));
  EXPECT_EQ(map.state, PressureMap::STATE_OK);
  EXPECT_EQ(map.header.stamp, ros::Time(rig.stamp));
  EXPECT_FLOAT_EQ(map.pitch_y, 0.012f);
  for (std::size_t taxel = 0; taxel < kRigTaxels; ++taxel) {
    EXPECT_EQ(map.pressure[taxel], knownPressure(taxel, 1, counts[taxel]));
    EXPECT_EQ(map.deviation[taxel], knownDeviation(taxel, 1, counts[taxel]));
    EXPECT_EQ(map.flags[taxel], 0);
  }
}

TEST_F(CalibrationNode, FlagsEachTaxelByItsCodeAndCurvature) {
  rig.lieOn({0, 10, 20, 5, 14, -20, 50, 0, 0, 0, 0, 0});
  reach([](const PressureMap& m) { return (m.flags[5] & PressureMap::FLAG_CURVATURE_EXTRAPOLATED) != 0; });
  const PressureMap map = rig.mapOf(rig.scan({500, 500, 500, 500, 500, 500, 500, 0, 10, 940, 1023, 500}));
  EXPECT_EQ(map.flags[2], 0);
  EXPECT_EQ(map.pressure[2], knownPressure(2, 2, 500));
  EXPECT_EQ(map.flags[3], PressureMap::FLAG_BETWEEN_CLASSES);
  EXPECT_EQ(map.flags[4], PressureMap::FLAG_BETWEEN_CLASSES);
  EXPECT_EQ(map.flags[6], PressureMap::FLAG_CURVATURE_EXTRAPOLATED);
  EXPECT_EQ(map.flags[7], PressureMap::FLAG_BELOW_RANGE | PressureMap::FLAG_READING_EXTRAPOLATED);
  EXPECT_EQ(map.flags[8], PressureMap::FLAG_BELOW_RANGE | PressureMap::FLAG_READING_EXTRAPOLATED);
  EXPECT_EQ(map.flags[9], PressureMap::FLAG_READING_EXTRAPOLATED);
  EXPECT_EQ(map.flags[10], PressureMap::FLAG_SATURATED | PressureMap::FLAG_READING_EXTRAPOLATED);
}

TEST_F(CalibrationNode, BlendsItsTablesByTheRuleOfTheFile) {
  // between classes of 0 and 10 1/m, whose tables differ by 10 Pa
  struct Expected {
    fsr::compensation::BlendRule blend;
    std::string surface;
    double above_flat;  // [Pa]
  };
  const double ten = std::exp(-49.0 / 32 + 9.0 / 32),
               twenty = std::exp(-289.0 / 32 + 9.0 / 32);  // scale 4 1/m
  for (const Expected& e :
       {Expected{fsr::compensation::BlendRule::kNearest, "new", 0.0},
        Expected{fsr::compensation::BlendRule::kInterpolate, "new", 3.0},
        Expected{fsr::compensation::BlendRule::kKernel, "new", (10 * ten + 20 * twenty) / (1 + ten + twenty)},
        Expected{fsr::compensation::BlendRule::kByName, "surface_2", 20.0}}) {
    fsr::calibration::Calibration calibration = test_support::smallCalibration(kSize, {0.0, 10.0, 20.0});
    calibration.tables.rule.blend = e.blend;
    calibration.tables.rule.length_scale = {4.0};
    for (fsr::regression::CodeTable& table : calibration.tables.tables)
      table.log_weight.assign(kRigFullScale + 1u, 0.0f);
    const std::string path = kFolder / "blended.h5";
    const std::string id = fsr::calibration::saveCalibration(calibration, path);
    ASSERT_TRUE(load(path).success);
    rig.lieOn({3.0f}, e.surface, ++mount);
    const PressureMap map = reach([&](const PressureMap& m) {
      const bool between = (m.flags[0] & PressureMap::FLAG_BETWEEN_CLASSES) != 0;
      return m.calibration == id && between == (e.blend != fsr::compensation::BlendRule::kByName);
    });
    EXPECT_NEAR(map.pressure[3], knownPressure(3, 0, 500) + e.above_flat, 0.02);
  }
}

TEST_F(CalibrationNode, SaysWhenCurvatureIsUnknown) {
  rig.lieOn({});
  reach([](const PressureMap& m) { return m.state == PressureMap::STATE_CURVATURE_UNKNOWN; });
}

TEST_F(CalibrationNode, TreatsACurvatureNoSheetCanHaveAsUnknown) {
  rig.lieOn({1e30f});
  const PressureMap map =
      reach([](const PressureMap& m) { return m.state == PressureMap::STATE_CURVATURE_UNKNOWN; });
  EXPECT_EQ(map.pressure[3], knownPressure(3, 0, 500));
}

TEST_F(CalibrationNode, FlagsATemperatureBeyondTraining) {
  auto warm = test_support::smallCalibration(kSize, {0.0, 10.0, 20.0});
  warm.trained.temperature = {22, 24};
  fsr::calibration::saveCalibration(warm, kFile);
  ASSERT_TRUE(load(kFile).success);
  ros::Publisher thermometer = ros::NodeHandle().advertise<sensor_msgs::Temperature>("temperature", 10, true);
  sensor_msgs::Temperature message;
  message.temperature = 40;
  thermometer.publish(message);
  reach([](const PressureMap& m) { return m.flags[5] == PressureMap::FLAG_TEMPERATURE_EXTRAPOLATED; });
  message.temperature = 23;
  thermometer.publish(message);
  reach([](const PressureMap& m) { return m.flags[5] == 0; });
  save(kFile, {0.0, 10.0, 20.0});
}

TEST_F(CalibrationNode, TreatsACurvatureOfAnotherSizeAsUnknown) {
  rig.lieOn(std::vector<float>(70, 10.0f));
  reach([](const PressureMap& m) { return m.state == PressureMap::STATE_CURVATURE_UNKNOWN; });
}

TEST_F(CalibrationNode, SaysWhenTheBoardIsAnotherOne) {
  rig.identify("board-2");
  reach([](const PressureMap& m) { return m.state == PressureMap::STATE_WRONG_SENSOR; });
  rig.identify("board-1");
  reach([](const PressureMap& m) { return m.state == PressureMap::STATE_OK; });
}

TEST_F(CalibrationNode, SaysWhenTheScanIsOfAnotherSizeOrFullScale) {
  auto scan = rig.scan(500);
  scan.full_scale = 4095;
  EXPECT_EQ(rig.mapOf(scan).state, PressureMap::STATE_SIZE_MISMATCH);
  scan = rig.scan(std::vector<std::uint16_t>(16, 500));
  scan.rows = scan.columns = 4;
  const PressureMap map = rig.mapOf(scan);
  EXPECT_EQ(map.state, PressureMap::STATE_SIZE_MISMATCH);
  ASSERT_EQ(map.pressure.size(), 16u);
  EXPECT_TRUE(std::isnan(map.pressure[0]));
  scan.rows = 64;  // and a scan whose size does not fit its counts
  EXPECT_EQ(rig.mapOf(scan).state, PressureMap::STATE_SIZE_MISMATCH);
  EXPECT_EQ(rig.mapOf(500).state, PressureMap::STATE_OK);
}

TEST_F(CalibrationNode, AppliesTheMasksOfUserAndBoard) {
  std::vector<std::uint8_t> taxels(kRigTaxels, 0);
  taxels[7] = 1;
  ASSERT_TRUE(mask(taxels).success);
  rig.identify("board-1", {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const PressureMap map = reach([](const PressureMap& m) { return m.flags[1] != 0; });
  EXPECT_EQ(map.flags[1], PressureMap::FLAG_MASKED);
  EXPECT_EQ(map.flags[7], PressureMap::FLAG_MASKED);
  EXPECT_TRUE(std::isnan(map.pressure[7]));
  EXPECT_EQ(map.flags[2], 0);
  EXPECT_FALSE(mask({1, 0, 1}).success);
}

TEST_F(CalibrationNode, ReplacesItsCalibrationWhileScansGoOn) {
  const std::string other = kFolder / "other.h5";
  const std::string first = rig.mapOf(500).calibration;
  const std::string second = save(other, {0.0, 10.0, 20.0, 30.0});
  rig.lieOn({30.0f});
  reach([](const PressureMap& m) { return m.pressure[0] == knownPressure(0, 2, 500); });
  const std::size_t before = rig.maps().size();
  const double stamp_before = rig.stamp;
  const Reply reply = whileScanning([&] { return load(other); });
  EXPECT_TRUE(reply.success) << reply.message;
  EXPECT_TRUE(contains(reply.message, other)) << reply.message;
  EXPECT_EQ(rig.mapOf(500).calibration, second);

  const auto scans = std::size_t(std::lround((rig.stamp - stamp_before) / 0.1));
  ASSERT_EQ(rig.maps().size() - before, scans) << "a map for each scan";
  for (std::size_t i = before; i < rig.maps().size(); ++i) {
    const PressureMap& map = *rig.maps()[i];
    const std::size_t curvature_class = map.calibration == first ? 2 : 3;
    const std::uint16_t code = i + 1 == rig.maps().size() ? 500 : 50;
    ASSERT_EQ(map.pressure[0], knownPressure(0, curvature_class, code));
  }
}

TEST_F(CalibrationNode, RefusesADamagedFileAndKeepsTheOldOne) {
  const std::string damaged = kFolder / "damaged.h5";
  save(damaged, {0.0, 10.0});
  {
    std::fstream file(damaged, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(5000);
    file.put('\x5a');
  }
  const std::string id = rig.mapOf(500).calibration;
  for (const std::string& path :
       {damaged, std::string("/nowhere/c.h5"), std::string("c.h5"), std::string()}) {
    const Reply reply = load(path);
    EXPECT_FALSE(reply.success);
    EXPECT_TRUE(contains(reply.message, path) && contains(reply.message, "still in use: " + kFile))
        << reply.message;
    const PressureMap map = rig.mapOf(500);
    EXPECT_EQ(map.calibration, id);
    EXPECT_EQ(map.state, PressureMap::STATE_OK);
  }
}

TEST_F(CalibrationNode, ReloadsTheFileInUse) {
  const std::string id = save(kFile, {0.0, 12.0, 20.0});
  const Reply reply = trigger("reload");
  EXPECT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(rig.mapOf(500).calibration, id);
  save(kFile, {0.0, 10.0, 20.0});
}

TEST_F(CalibrationNode, TaresTheSheetAtRestAndKeepsItOnDisk) {
  const Reply reply = whileScanning([] { return trigger("tare"); });
  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_TRUE(contains(reply.message, kTareFile)) << reply.message;
  EXPECT_TRUE(fs::exists(kTareFile));
  const PressureMap map = rig.mapOf(500);
  EXPECT_EQ(map.flags[4], PressureMap::FLAG_TARED);
  EXPECT_EQ(map.pressure[4], knownPressure(4, 0, 500) - knownPressure(4, 0, 50));
  EXPECT_TRUE(trigger("clear_tare").success);
  EXPECT_EQ(rig.mapOf(500).pressure[4], knownPressure(4, 0, 500));
  EXPECT_FALSE(fs::exists(kTareFile));
}

TEST_F(CalibrationNode, RefusesATareUnderLoadOrUnderALimb) {
  const Reply load_reply =
      whileScanning([] { return trigger("tare"); }, [](int) { return std::uint16_t{400}; });
  EXPECT_FALSE(load_reply.success);
  EXPECT_TRUE(contains(load_reply.message, "~tare_limit")) << load_reply.message;
  const Reply limb = whileScanning([] { return trigger("tare"); },
                                   [](int i) { return std::uint16_t(i % 2 == 0 ? 30 : 150); });
  EXPECT_FALSE(limb.success);
  EXPECT_TRUE(contains(limb.message, "scatters")) << limb.message;
  EXPECT_EQ(rig.mapOf(500).flags[4], 0);
}

TEST_F(CalibrationNode, DropsTheTareOnAnotherMountOrCalibration) {
  ASSERT_TRUE(whileScanning([] { return trigger("tare"); }).success);
  rig.lieOn({0.0f}, "flat", ++mount);
  reach([](const PressureMap& m) { return m.flags[4] == 0; });
  EXPECT_TRUE(test_support::await([] { return !fs::exists(kTareFile); }));

  ASSERT_TRUE(whileScanning([] { return trigger("tare"); }).success);
  const std::string other = kFolder / "other.h5";
  save(other, {0.0, 30.0});
  ASSERT_TRUE(load(other).success);
  EXPECT_EQ(rig.mapOf(500).flags[4], 0);
  EXPECT_TRUE(test_support::await([] { return !fs::exists(kTareFile); }));
}

// What is not the node's own is neither replaced nor removed.
TEST_F(CalibrationNode, AMaskReplacesNothingButAMask) {
  ASSERT_TRUE(mask({}).success);
  std::ofstream(kFolder / "mask.yaml") << "#ROSBAG V2.0\nprecious";
  std::vector<std::uint8_t> taxels(12, 0);
  taxels[4] = 1;
  const Reply reply = mask(taxels);
  EXPECT_FALSE(reply.success);
  EXPECT_TRUE(contains(reply.message, "mask.yaml: is a bag")) << reply.message;
  EXPECT_EQ(fs::file_size(kFolder / "mask.yaml"), 21u);
  EXPECT_EQ(rig.mapOf(500).flags[4], 0) << "what is not stored is not used";
  fs::remove(kFolder / "mask.yaml");
}

TEST_F(CalibrationNode, DescribesTheCalibrationInUse) {
  const test_support::Listener<CalibrationInfo> infos("calibration_info");
  ASSERT_TRUE(
      test_support::await([&] { return !infos.messages.empty() && !infos.messages.back()->id.empty(); }));
  const CalibrationInfo info = *infos.messages.back();
  EXPECT_EQ(info.path, kFile);
  EXPECT_EQ(info.scheme, "per_curvature");
  EXPECT_EQ(info.model, "grnn");
  EXPECT_EQ(info.sensor_serial, "board-1");
  EXPECT_EQ(info.pressure_high, 620e3);
  EXPECT_TRUE(std::isnan(info.temperature_low));
  EXPECT_EQ(info.class_curvatures, (std::vector<float>{0.0f, 10.0f, 20.0f}));
  EXPECT_TRUE(test_support::await([&] { return infos.messages.back()->header.stamp > info.header.stamp; }))
      << "repeated for recorders";
}

TEST_F(CalibrationNode, ReportsErrorsInDiagnostics) {
  rig.identify("board-2");
  reach([](const PressureMap& m) { return m.state == PressureMap::STATE_WRONG_SENSOR; });
  test_support::Diagnostics diagnostics;
  EXPECT_TRUE(test_support::await([&] {
    rig.publishScan(500);
    return diagnostics.says("fsr/calibration: maps", diagnostic_msgs::DiagnosticStatus::ERROR, "board-2");
  }));
}

/// The second node: it fills bad taxels, and its curvature is stale after 3 s.
class FillingNode : public testing::Test {
 protected:
  static void TearDownTestSuite() { fs::remove_all(kFolder); }

  void SetUp() override {
    ASSERT_TRUE(rig.connected());
    rig.identify("board-1");
    rig.stamp += 1e5;  // an interval of time that no other test uses
    rig.lieOn({0.0f});
    rig.mapWhen(500, [](const PressureMap& m) { return !m.flags.empty() && m.state == m.STATE_OK; });
  }
  CalibrationRig rig{"filling/pressure_map"};
};

TEST_F(FillingNode, SaysWhenCurvatureIsStaleUntilTimeRunsBack) {
  EXPECT_EQ(rig.mapOf(500).state, PressureMap::STATE_OK);
  rig.stamp += 10;
  EXPECT_EQ(rig.mapOf(500).state, PressureMap::STATE_CURVATURE_STALE);
  rig.stamp -= 1000;  // as when a bag starts again
  EXPECT_EQ(rig.mapOf(500).state, PressureMap::STATE_OK);
}

TEST_F(FillingNode, FillsADeadAndAStuckTaxelFromTheirNeighbours) {
  PressureMap map;
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint16_t> counts(kRigTaxels, std::uint16_t(450 + 300 * std::sin(0.1 * i)));
    counts[0] = 0;
    counts[11] = 321;
    rig.lieOn({0.0f});
    map = rig.mapOf(rig.scan(counts));
  }
  ASSERT_EQ(map.flags.size(), kRigTaxels);
  EXPECT_TRUE(map.flags[0] & PressureMap::FLAG_DEAD && map.flags[0] & PressureMap::FLAG_FILLED)
      << map.flags[0];
  EXPECT_TRUE(map.flags[11] & PressureMap::FLAG_STUCK && map.flags[11] & PressureMap::FLAG_FILLED);
  EXPECT_NEAR(map.pressure[0], map.pressure[1], 1.0f);
  EXPECT_NEAR(map.pressure[11], map.pressure[10], 1.0f);
  EXPECT_EQ(map.flags[5], 0);
}

}  // namespace
