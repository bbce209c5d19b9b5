#include "ros/messages/driver_messages.h"

#include <gtest/gtest.h>

#include <array>

#include "support/holds.h"

namespace {

using fsr_ros::DriverSettings;

constexpr fsr::protocol::PacketTime kTime = {1'700'000'000'123'456'789, 5'000'000'000};

TEST(DriverMessages, ConvertsAScanWithStampAndDeviceTime) {
  const std::array<std::uint16_t, 6> counts = {0, 1, 2, 3, 4, 4095};
  const auto message =
      fsr_ros::scanMessage({17, 705032704, 40}, {{2, 3}, 4095, 5000, counts.data()}, kTime, DriverSettings());
  EXPECT_EQ(message->header.stamp, ros::Time(1700000000, 123456789));
  EXPECT_EQ(message->header.frame_id, "fsr_matrix");
  EXPECT_EQ(message->sequence, 17U);
  EXPECT_EQ(message->device_time, 5'000'000'000U);
  EXPECT_FLOAT_EQ(message->scan_duration, 0.005F);
  EXPECT_EQ(message->rows, 2);
  EXPECT_EQ(message->columns, 3);
  EXPECT_EQ(message->full_scale, 4095);
  EXPECT_EQ(message->counts, std::vector<std::uint16_t>(counts.begin(), counts.end()));
}

TEST(DriverMessages, AddsTheAmbientPressureToAGaugeReading) {
  DriverSettings settings;
  settings.transducer_line = {-1000, 2.5, false, 40};
  settings.ambient_pressure = 100000;
  const auto message = fsr_ros::pressureMessage(4000, kTime, settings);
  EXPECT_DOUBLE_EQ(message->fluid_pressure, -1000 + 2.5 * 4000 + 100000);
  EXPECT_DOUBLE_EQ(message->variance, 1600);
}

TEST(DriverMessages, DoesNotChangeAnAbsoluteReading) {
  DriverSettings settings;
  settings.transducer_line = {0, 10, true, 0};
  const auto message = fsr_ros::pressureMessage(-3, kTime, settings);
  EXPECT_DOUBLE_EQ(message->fluid_pressure, -30);
  EXPECT_DOUBLE_EQ(message->variance, 0);
}

TEST(DriverMessages, GivesTheDefaultTransducerItsTwelveBits) {
  const DriverSettings settings;
  EXPECT_DOUBLE_EQ(fsr_ros::pressureMessage(0, kTime, settings)->fluid_pressure, -103e3 + 101325);
  EXPECT_DOUBLE_EQ(fsr_ros::pressureMessage(4096, kTime, settings)->fluid_pressure, 1034e3 + 101325);
}

TEST(DriverMessages, GivesTemperatureInDegrees) {
  EXPECT_DOUBLE_EQ(fsr_ros::temperatureMessage(23750, kTime, DriverSettings())->temperature, 23.75);
  EXPECT_DOUBLE_EQ(fsr_ros::temperatureMessage(-500, kTime, DriverSettings())->temperature, -0.5);
}

TEST(DriverMessages, MarksAnEdgeOfTheTriggerWithItsDeviation) {
  const fsr_pressure_map::Event event = fsr_ros::triggerMessage({true, 2}, kTime, DriverSettings());
  EXPECT_EQ(event.header.stamp, ros::Time(1700000000, 123456789));
  EXPECT_EQ(event.kind, "sync");
  EXPECT_EQ(event.label, "trigger rising +- 0.002 ms");
  EXPECT_EQ(fsr_ros::triggerMessage({false, 2500}, kTime, DriverSettings()).label,
            "trigger falling +- 2.500 ms");
}

TEST(DriverMessages, ShiftsStampsByTheOffset) {
  DriverSettings settings;
  settings.time_offset = -0.25;
  EXPECT_EQ(fsr_ros::headerAt(2'000'000'000, settings).stamp, ros::Time(1, 750'000'000));
  EXPECT_TRUE(fsr_ros::headerAt(200'000'000, settings).stamp.isZero()) << "before time began";
}

TEST(DriverMessages, DescribesTheMatrix) {
  DriverSettings settings;
  settings.sealing = "pdms";
  settings.pitch_y = 0.012;
  fsr::protocol::IdentityPacket identity;
  identity.serial = "FSR-\xC3\n42";
  identity.size = {16, 10};
  identity.full_scale = 65535;
  identity.scan_period = 2000;
  const fsr_ros::Board board = fsr_ros::toBoard(identity);
  EXPECT_DOUBLE_EQ(board.scan_period, 0.002);
  fsr_pressure_map::MatrixInfo info = fsr_ros::matrixInfo(board, settings);
  EXPECT_EQ(info.serial, "FSR-??42");
  EXPECT_EQ(info.sensor_id, "FSR-??42") << "without ~sensor_id the serial number";
  EXPECT_EQ(info.rows, 16);
  EXPECT_EQ(info.columns, 10);
  EXPECT_EQ(info.full_scale, 65535);
  EXPECT_FLOAT_EQ(info.pitch_x, 0.010F);
  EXPECT_FLOAT_EQ(info.pitch_y, 0.012F);
  EXPECT_EQ(info.sealing, "pdms");
  EXPECT_DOUBLE_EQ(info.ambient_pressure, 101325);
  settings.sensor_id = "left";
  EXPECT_EQ(fsr_ros::matrixInfo(board, settings).sensor_id, "left");
}

TEST(SameBoardSentence, NamesTwoSheetsOfOneBoardAndNoneOfUnknownOnes) {
  EXPECT_EQ(fsr_ros::sameBoardSentence({{"/a", "1"}, {"/b", ""}, {"/c", "2"}, {"/d", ""}}), "");
  EXPECT_TRUE(test_support::holds(fsr_ros::sameBoardSentence({{"/a", "1"}, {"/b", "2"}, {"/c", "2"}}),
                                  {"/b and /c", "serial number, 2", "serial_port"}));
}

}  // namespace
