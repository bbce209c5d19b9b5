#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <gtest/gtest.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>
#include <std_srvs/SetBool.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "ros/live/serve.h"
#include "support/board_packets.h"
#include "support/diagnostics.h"
#include "support/holds.h"
#include "support/pty.h"
#include "support/ros_listener.h"

namespace {

using fsr_pressure_map::MatrixFrame;
using test_support::await;
using test_support::Diagnostics;
using test_support::Listener;
using Level = diagnostic_msgs::DiagnosticStatus;

std::string parameter(const std::string& name) {
  return ros::NodeHandle("~").param<std::string>(name, "");
}

std::uint16_t countOf(std::uint32_t scan, int taxel) {
  return static_cast<std::uint16_t>((scan * 7 + taxel) % 4096);
}

std::vector<std::uint16_t> countsOf(std::uint32_t scan) {
  std::vector<std::uint16_t> counts(6);
  for (int i = 0; i < 6; ++i) counts[i] = countOf(scan, i);
  return counts;
}

// A 2 x 3 board at 100 Hz whose counts encode the number of the scan.
class Board {
 public:
  explicit Board(const std::string& port) : pty_(port) {}

  void introduceItself() { pty_.write(test_support::identityPacket(1, time(next_), 2, 3, "FSR-0042")); }
  void sendScans(int count) {
    for (int i = 0; i < count; ++i, ++next_) {
      pty_.write(test_support::scanPacket(next_, time(next_), 2, 3, countsOf(next_)));
    }
  }
  void sendReading(std::int32_t counts) {
    pty_.write(test_support::transducerPacket(next_, time(next_), counts));
  }
  // 3 ms behind the last scan.
  void sendTrigger(bool high) {
    pty_.write(test_support::triggerPacket(next_, time(next_ - 1) + 3000, high, 2));
  }
  void sendTemperature(std::int32_t value) {
    pty_.write(test_support::temperaturePacket(next_, time(next_), value));
  }

 private:
  static std::uint32_t time(std::uint32_t scan) { return scan * 10'000; }  // [us]

  test_support::Pty pty_;
  std::uint32_t next_ = 1;
};

Diagnostics& diagnostics() {
  static Diagnostics instance;
  return instance;
}

const std::string kWaiting = "waiting for the board: there is no serial port ";

// Connects a board to a driver that waits for one, and waits until the driver reads it. (Bytes sent before
// the port is open are stale and are dropped.)
std::unique_ptr<Board> plugIn(const std::string& port, const std::string& driver) {
  EXPECT_EQ(diagnostics().await(driver + ": link", Level::ERROR, kWaiting + port), kWaiting + port);
  auto board = std::make_unique<Board>(port);
  EXPECT_TRUE(diagnostics().awaitOpenPort(driver));
  return board;
}

// Every test unplugs its board at its end, so that each test starts with a driver that waits.
class DriverNode : public testing::Test {
 protected:
  std::string port_ = parameter("port");
};

TEST_F(DriverNode, SaysWhichPortItWaitsForWhileThatIsMissing) {
  const std::string waits = "waiting for the board: there is no serial port " + port_;
  EXPECT_EQ(diagnostics().await("fsr/driver: link", Level::ERROR, waits), waits);
}

TEST_F(DriverNode, PublishesEveryScanWithItsCountsAndIncreasingStamps) {
  Listener<MatrixFrame> raw("fsr/raw");
  ASSERT_TRUE(raw.connected());
  const auto board = plugIn(port_, "fsr/driver");
  board->sendScans(200);
  ASSERT_TRUE(raw.has(200));
  ros::Time last;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const MatrixFrame& frame = *raw.messages[i];
    ASSERT_EQ(frame.sequence, i + 1);
    ASSERT_EQ(frame.counts, countsOf(i + 1));
    ASSERT_EQ(frame.device_time, (i + 1) * 10'000);
    ASSERT_GT(frame.header.stamp, last) << i;
    last = frame.header.stamp;
  }
  EXPECT_EQ(raw.messages.front()->rows, 2);
  EXPECT_EQ(raw.messages.front()->columns, 3);
  EXPECT_EQ(raw.messages.front()->full_scale, 4095);
  EXPECT_LT(std::abs((last - ros::Time::now()).toSec()), 60);
}

TEST_F(DriverNode, PublishesAnEdgeOfTheTriggerAsAnEvent) {
  Listener<fsr_pressure_map::Event> events("fsr/events");
  ASSERT_TRUE(events.connected());
  const auto board = plugIn(port_, "fsr/driver");
  board->sendScans(1);
  board->sendTrigger(true);
  ASSERT_TRUE(events.has(1));
  EXPECT_EQ(events.messages[0]->kind, "sync");
  EXPECT_EQ(events.messages[0]->label, "trigger rising +- 0.002 ms");
  EXPECT_NEAR((events.messages[0]->header.stamp - ros::Time::now()).toSec(), 0, 5);
}

TEST_F(DriverNode, SurvivesUnpluggingAndReadsTheBoardThatComesBack) {
  Listener<MatrixFrame> raw("fsr/raw");
  ASSERT_TRUE(raw.connected());
  for (std::size_t round = 1; round <= 2; ++round) {
    const auto board = plugIn(port_, "fsr/driver");
    board->sendScans(3);
    ASSERT_TRUE(raw.has(3 * round));
  }
}

// A board that sends fast and its name late: every scan that waited for the name is published.
TEST_F(DriverNode, PublishesEveryScanThatWaitedForTheBoardsName) {
  constexpr std::uint32_t kScans = 5000;
  Listener<MatrixFrame> raw("fsr/raw");
  ASSERT_TRUE(raw.connected());
  {
    const auto board = plugIn(port_, "fsr/driver");
    board->introduceItself();
    board->sendScans(1);
    ASSERT_TRUE(raw.has(1));
  }
  const auto board = plugIn(port_, "fsr/driver");
  board->sendScans(kScans);
  board->introduceItself();
  ASSERT_TRUE(raw.has(1 + kScans));
  for (std::uint32_t i = 1; i <= kScans; ++i) ASSERT_EQ(raw.messages[i]->sequence, i);
}

TEST_F(DriverNode, PublishesAbsolutePressureAndTemperature) {
  Listener<sensor_msgs::FluidPressure> pressure("fsr/chamber_pressure");
  Listener<sensor_msgs::Temperature> temperature("fsr/temperature");
  ASSERT_TRUE(pressure.connected() && temperature.connected());
  const auto board = plugIn(port_, "fsr/driver");
  board->sendReading(4000);
  board->sendTemperature(23750);
  ASSERT_TRUE(pressure.has(1) && temperature.has(1));
  EXPECT_DOUBLE_EQ(pressure.messages.front()->fluid_pressure, -1000 + 2.5 * 4000 + 100000);
  EXPECT_DOUBLE_EQ(pressure.messages.front()->variance, 1600);
  EXPECT_DOUBLE_EQ(temperature.messages.front()->temperature, 23.75);
}

TEST_F(DriverNode, RepeatsTheDescriptionOfTheMatrix) {
  Listener<fsr_pressure_map::MatrixInfo> info("fsr/matrix_info");
  const auto board = plugIn(port_, "fsr/driver");
  board->introduceItself();
  ASSERT_TRUE(await([&] { return !info.messages.empty() && info.messages.back()->serial == "FSR-0042"; }));
  ASSERT_TRUE(info.has(info.messages.size() + 1)) << "it is repeated each second";
  EXPECT_EQ(info.messages.back()->rows, 2);
  EXPECT_EQ(info.messages.back()->columns, 3);
  EXPECT_EQ(info.messages.back()->firmware, "1.2.0");
  EXPECT_DOUBLE_EQ(info.messages.back()->ambient_pressure, 100000);
}

TEST_F(DriverNode, ComplainsAboutASilentBoard) {
  const auto board = plugIn(port_, "fsr/driver");
  const std::string complaint = port_ + " has sent nothing for";
  EXPECT_EQ(diagnostics().await("fsr/driver: link", Level::ERROR, complaint), complaint);
}

TEST_F(DriverNode, ClosesAndOpensThePortByService) {
  const auto board = plugIn(port_, "fsr/driver");
  std_srvs::SetBool call;
  ASSERT_TRUE(ros::service::call("fsr/driver/set_enabled", call));
  EXPECT_TRUE(call.response.success);
  EXPECT_EQ(diagnostics().await("fsr/driver: link", Level::WARN, "disabled"), "disabled");
  call.request.data = 1;
  ASSERT_TRUE(ros::service::call("fsr/driver/set_enabled", call));
  EXPECT_NE(call.response.message.find(port_), std::string::npos) << call.response.message;
  EXPECT_TRUE(diagnostics().awaitOpenPort("fsr/driver"));
}

class DriverReplay : public testing::Test {
 protected:
  ~DriverReplay() override { std::remove(parameter("capture").c_str()); }
};

TEST_F(DriverReplay, GivesTheSameScansAsTheLiveBoard) {
  Listener<MatrixFrame> raw("replay/raw");
  ros::NodeHandle replay("replay_driver");
  replay.setParam("replay_file", parameter("capture"));
  const fsr_ros::Server driver = fsr_ros::makeDriver(ros::NodeHandle("replay"), replay);
  ASSERT_TRUE(raw.has(206));
  for (std::uint32_t i = 0; i < 200; ++i) {
    ASSERT_EQ(raw.messages[i]->sequence, i + 1);
    ASSERT_EQ(raw.messages[i]->counts, countsOf(i + 1));
  }
}

TEST(DriverNodelet, LoadsIntoAManagerAndPublishes) {
  Listener<MatrixFrame> raw("nodelets/raw");
  ASSERT_TRUE(raw.connected());
  const auto board = plugIn(parameter("nodelet_port"), "nodelets/driver");
  board->sendScans(5);
  ASSERT_TRUE(raw.has(5));
  EXPECT_EQ(raw.messages[4]->counts, countsOf(5));
}

// Runs the node with `arguments` and stores its output in `output`.
int exitStatus(const std::string& arguments, std::string& output) {
  FILE* pipe =
      popen(("rosrun fsr_pressure_map driver_node __name:=refused " + arguments + " 2>&1").c_str(), "r");
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) output.push_back(static_cast<char>(c));
  return WEXITSTATUS(pclose(pipe));
}

TEST_F(DriverNode, RefusesABadParameterWithASentenceAndStatusTwo) {
  std::string output;
  EXPECT_EQ(exitStatus("_serial_baud:=-5", output), 2);
  EXPECT_TRUE(test_support::holds(
      output, {"parameter /refused/serial_baud is -5, but must be a whole number, 0 to 12000000 baud"}));
}

TEST_F(DriverNode, RefusesAReplayThatIsNoCapture) {
  ros::param::del("/refused");
  std::string output;
  EXPECT_EQ(exitStatus("_replay_file:=/dev/null", output), 2);
  EXPECT_NE(output.find("/dev/null: is a device or a pipe"), std::string::npos) << output;
}

}  // namespace
