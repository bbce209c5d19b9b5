#include "ros/live/calibration_health.h"
#include "support/holds.h"

#include <gtest/gtest.h>

namespace fsr_ros {
namespace {

using Status = diagnostic_updater::DiagnosticStatusWrapper;
using Level = diagnostic_msgs::DiagnosticStatus;

CalibrationHealth healthy() {
  CalibrationHealth health;
  health.info.id = "3f2a";
  health.info.path = "/data/c.h5";
  health.info.scheme = "per_curvature";
  health.info.sensor_serial = "A1";
  health.board = "A1";
  health.scans = 100;
  health.map.reset({{2, 3}});
  health.map.state = fsr::map::MapState::kOk;
  health.map.pressure = {0, 5e3f, 10e3f, 20e3f, NAN, 30e3f};
  return health;
}

std::string valueOf(const Status& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "no such key";
}

Status maps(const CalibrationHealth& now, std::uint64_t scans_before = 90) {
  CalibrationHealth before;
  before.scans = scans_before;
  Status status;
  judgeMaps(before, now, 1.0, "/fsr/raw", 10e3, status);
  return status;
}

TEST(CalibrationHealth, IsOkWhenMapsAreCalibrated) {
  const Status status = maps(healthy());
  EXPECT_EQ(status.level, Level::OK);
  EXPECT_EQ(valueOf(status, "maps a second of wall time"), "10");
  EXPECT_EQ(valueOf(status, "taxels in contact"), "3");
  EXPECT_EQ(valueOf(status, "peak in contact, gauge [kPa]"), "30");
}

TEST(CalibrationHealth, SaysOfWhatTheCalibrationIsACorrection) {
  CalibrationHealth health = healthy();
  Status trained, corrected;
  judgeCalibration(health, trained);
  EXPECT_EQ(valueOf(trained, "correction"), "none");
  health.info.parent = "0123456789ab";
  health.info.corrected = "2026-11-23T14:05:00Z";
  judgeCalibration(health, corrected);
  EXPECT_EQ(corrected.level, Level::OK);
  EXPECT_EQ(valueOf(corrected, "correction"), "corrected on 2026-11-23 from 0123456789ab");
}

TEST(CalibrationHealth, SaysWhatTheDeviationOfTheMapIs) {
  CalibrationHealth health = healthy();
  health.deviation = "that of the tables times 0.80 to 1.25 by pressure";
  Status status;
  judgeCalibration(health, status);
  EXPECT_EQ(valueOf(status, "deviation of the map"), health.deviation);
}

TEST(CalibrationHealth, WarnsOfATemperatureBeyondTraining) {
  CalibrationHealth health = healthy();
  health.temperature = 40;
  health.info.temperature_low = 22;
  health.info.temperature_high = 23.5;
  health.map.flags.assign(6, fsr::map::taxel_flag::kTemperatureExtrapolated);
  const Status status = maps(health);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_TRUE(test_support::holds(status.message, {"temperature is beyond", "22 to 23.5 degrees Celsius"}));
  EXPECT_EQ(valueOf(status, "temperature [degree Celsius]"), "40");
}

TEST(CalibrationHealth, WarnsOfAnUnknownTemperatureWhereItIsNeeded) {
  CalibrationHealth health = healthy();
  EXPECT_EQ(maps(health).level, Level::OK);
  health.corrects_temperature = true;
  const Status status = maps(health);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_TRUE(test_support::holds(status.message, {"temperature is unknown", "not corrected"}));
  health.temperature = 23;
  EXPECT_EQ(maps(health).level, Level::OK);
}

// After each start it is so: no warning.
TEST(CalibrationHealth, SaysWhichShareIsNotSettled) {
  const char* const key = "share of taxels whose history is not settled [%]";
  CalibrationHealth health = healthy();
  EXPECT_EQ(valueOf(maps(health), key), "0");
  health.map.flags[1] = health.map.flags[5] = fsr::map::taxel_flag::kHistoryShort;
  EXPECT_EQ(valueOf(maps(health), key), "40");  // taxel 4 has no reading
  EXPECT_EQ(maps(health).level, Level::OK);
}

TEST(CalibrationHealth, NamesTheTopicWithoutScans) {
  const Status status = maps(healthy(), 100);
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_EQ(status.message, "waiting for scans: none has come on /fsr/raw");
}

TEST(CalibrationHealth, NamesDeadTaxelsByRowAndColumn) {
  CalibrationHealth health = healthy();
  health.map.flags[4] = fsr::map::taxel_flag::kDead;
  const Status status = maps(health);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_EQ(valueOf(status, "dead taxels (row, column)"), "(1, 1)");
}

TEST(CalibrationHealth, NamesBothBoardsWhenTheSensorIsWrong) {
  CalibrationHealth health = healthy();
  health.board = "B2";
  health.map.state = fsr::map::MapState::kWrongSensor;
  const Status status = maps(health);
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_TRUE(test_support::holds(status.message, {"B2", "A1", "the board has the serial number B2"}));
}

TEST(CalibrationHealth, WarnsWithoutCurvature) {
  CalibrationHealth health = healthy();
  health.map.state = fsr::map::MapState::kCurvatureUnknown;
  EXPECT_EQ(maps(health).level, Level::WARN);
  health.surface_complaint = "x has 3 values";
  EXPECT_NE(maps(health).message.find("x has 3 values"), std::string::npos);
}

TEST(CalibrationHealth, SaysWhatItWaitsForWithoutACalibration) {
  CalibrationHealth health;
  health.complaint = "~calibration is empty: call ~load_calibration with the path of a file";
  Status status;
  judgeCalibration(health, status);
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_EQ(status.message, "waiting for a calibration: " + health.complaint);
}

TEST(CalibrationHealth, SaysWhyTheMapIsNotTaredAndWhatATareIsWorth) {
  CalibrationHealth health = healthy();
  health.session_zero = {fsr::calibration::SessionTare::kTrained, 9060, 1210};
  Status status;
  judgeCalibration(health, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_TRUE(test_support::holds(status.message, {"1.21 kPa", "9.06 kPa", "~tare"}));
  health.tare_refusal = "the tare is refused: the taxel in row 0, column 0 reads 45 kPa at rest";
  EXPECT_EQ(tareSentence(health).find("not tared, because " + health.tare_refusal), 0u);
  health.tare.emplace();
  judgeCalibration(health, status);
  EXPECT_EQ(status.level, Level::OK);
  EXPECT_EQ(tareSentence(health), "");
  EXPECT_TRUE(test_support::holds(tareSentence(healthy()), {"not tared"}));
}

TEST(CalibrationHealth, WarnsOfNoTareThatMayBeWorthNothing) {
  CalibrationHealth health = healthy();
  health.session_zero.tare = fsr::calibration::SessionTare::kTablesAlone;
  Status status;
  judgeCalibration(health, status);
  EXPECT_EQ(status.level, Level::OK) << status.message;
  EXPECT_TRUE(test_support::holds(tareSentence(health), {"~tare", "not tared"}));
}

// What the panel reads.
TEST(CalibrationHealth, SaysWhetherTheSurfaceAgreesWithTheSheetAtRest) {
  const auto judged = [](const CalibrationHealth& health) {
    Status status;
    judgeCalibration(health, status);
    return status;
  };
  using fsr::calibration::ShapeVerdict;
  CalibrationHealth health = healthy();
  EXPECT_EQ(valueOf(judged(health), kRestVerdictKey), kRestOpen);
  EXPECT_EQ(valueOf(judged(health), kRestKey), "not compared yet");
  health.no_shape = "train again";
  EXPECT_EQ(valueOf(judged(health), kRestVerdictKey), kRestUnknown);
  EXPECT_EQ(valueOf(judged(health), kRestKey), "how the sheet lies cannot be told: train again");
  health.no_shape = "";
  health.shape.sentence = "so it rests";
  EXPECT_EQ(valueOf(judged(health), kRestVerdictKey), kRestUnknown);
  health.shape.verdict = ShapeVerdict::kAgrees;
  EXPECT_EQ(valueOf(judged(health), kRestVerdictKey), kRestAgrees);
  EXPECT_EQ(valueOf(judged(health), kRestKey), "so it rests");
  EXPECT_EQ(judged(health).level, Level::OK);
  health.shape.verdict = ShapeVerdict::kDisagrees;
  EXPECT_EQ(valueOf(judged(health), kRestVerdictKey), kRestDisagrees);
  EXPECT_EQ(judged(health).level, Level::WARN);
}

TEST(CalibrationHealth, SaysWhoPublishesTheCurvature) {
  Status status;
  CalibrationHealth health = healthy();
  judgeCalibration(health, status);
  EXPECT_EQ(valueOf(status, kCurvatureSourceKey), kCurvaturePublished);
  health.estimates_curvature = true;
  Status estimated;
  judgeCalibration(health, estimated);
  EXPECT_EQ(valueOf(estimated, kCurvatureSourceKey), kCurvatureEstimated);
}

TEST(CalibrationHealth, SaysWhatWasDoneAtTheLastMarkedRest) {
  CalibrationHealth health = healthy();
  Status none;
  judgeCalibration(health, none);
  EXPECT_EQ(valueOf(none, kMarkedRestKey), kNoMarkedRest);
  health.marked = "doff: compared";
  Status marked;
  judgeCalibration(health, marked);
  EXPECT_EQ(valueOf(marked, kMarkedRestKey), "doff: compared");
}

}  // namespace
}  // namespace fsr_ros
