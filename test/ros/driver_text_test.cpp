#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/FluidPressure.h>
#include <sys/wait.h>

#include <algorithm>
#include <memory>
#include <string>

#include "support/diagnostics.h"
#include "support/holds.h"
#include "support/program_output.h"
#include "support/pty.h"
#include "support/ros_listener.h"

namespace {

using fsr_pressure_map::MatrixFrame;
using test_support::await;
using test_support::Listener;

// A board of 2 x 3 taxels at 100 Hz.
class Sketch {
 public:
  explicit Sketch(const std::string& port) : pty_(port) {}

  void print(const std::string& text) { pty_.write({text.begin(), text.end()}); }
  // Scan `number` has the counts number, number + 1 ..., and ten times its number from the transducer.
  static std::string line(int number) {
    std::string text = std::to_string(1000 + 10 * number);
    for (int taxel = 0; taxel < 6; ++taxel) text += "," + std::to_string(number + taxel);
    return text + "," + std::to_string(10 * number) + "\r\n";
  }

 private:
  test_support::Pty pty_;
};

class TextDriver : public testing::Test {
 protected:
  test_support::Diagnostics diagnostics_;
  std::string port_ = ros::NodeHandle("~").param<std::string>("port", "");

  std::unique_ptr<Sketch> plugIn() {
    EXPECT_TRUE(await([&] { return says("waiting for the board"); }));
    auto sketch = std::make_unique<Sketch>(port_);
    EXPECT_TRUE(diagnostics_.awaitOpenPort("fsr/driver"));
    return sketch;
  }
  bool says(const std::string& part) { return diagnostics_.says("fsr/driver: link", part); }
  std::string valueOf(const std::string& key) { return diagnostics_.valueOf("fsr/driver: scans", key); }
};

TEST_F(TextDriver, PublishesTheScansAndReadingsOfASketchAndCountsDamage) {
  Listener<MatrixFrame> raw("fsr/raw");
  Listener<sensor_msgs::FluidPressure> pressure("fsr/chamber_pressure");
  Listener<fsr_pressure_map::MatrixInfo> info("fsr/matrix_info");
  ASSERT_TRUE(raw.connected() && pressure.connected());
  const auto sketch = plugIn();
  sketch->print("9,9\r\ntime,a,b,c,d,e,f,p\r\n# a comment\r\n");
  for (int i = 1; i <= 10; ++i) sketch->print(Sketch::line(i));
  sketch->print("1110,1,2,3,4,5,6\n1120,1,2,3,4,5,2000,0\n1130,1,2,?,4,5,6,0\n1140,1,\xFE,3\n");
  sketch->print(std::string(1000, '1') + "\n");
  for (int i = 16; i <= 20; ++i) sketch->print(Sketch::line(i));

  ASSERT_TRUE(raw.has(15) && pressure.has(15));
  const MatrixFrame& first = *raw.messages[0];
  EXPECT_EQ(first.counts, (std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(first.rows, 2);
  EXPECT_EQ(first.columns, 3);
  EXPECT_EQ(first.full_scale, 1023);
  EXPECT_EQ(first.device_time, 1'010'000U);
  for (int i = 1; i < 15; ++i) {
    EXPECT_GT(raw.messages[i]->header.stamp, raw.messages[i - 1]->header.stamp) << i;
  }
  EXPECT_EQ(raw.messages[10]->sequence, 16U) << "five damaged lines";
  EXPECT_EQ(raw.messages[14]->device_time, 1'200'000U);
  EXPECT_DOUBLE_EQ(pressure.messages[14]->fluid_pressure, -1000 + 2.5 * 200 + 100000);
  EXPECT_EQ(pressure.messages[14]->header.stamp, raw.messages[14]->header.stamp);
  EXPECT_TRUE(await([&] { return !info.messages.empty() && info.messages.back()->rows == 2; }));

  EXPECT_TRUE(await([&] { return valueOf("scans lost") == "5"; }));
  for (const char* cause : {"dropped: line cut by start or end", "dropped: line too long",
                            "dropped: line not in ASCII", "dropped: line not of whole numbers",
                            "dropped: wrong number of counts", "dropped: count above full scale"}) {
    EXPECT_EQ(valueOf(cause), "1") << cause;
  }
  EXPECT_EQ(valueOf("lines without numbers"), "2");
}

TEST_F(TextDriver, SaysHowManyCountsALineShouldHave) {
  Listener<rosgraph_msgs::Log> log("/rosout");
  ASSERT_TRUE(log.connected());
  const auto sketch = plugIn();
  const std::string sentence = "no scan is published: " + port_ +
                               " sends lines with 4 numbers behind the time, but rows x columns is 2 x 3 = 6 "
                               "counts, and text_transducer adds a reading";
  EXPECT_TRUE(await([&] {
    sketch->print("10,1,2,3,4\n");
    return diagnostics_.says("fsr/driver: scans", sentence);
  }));
  const auto logged = [&](const std::string& part) {
    return std::any_of(log.messages.begin(), log.messages.end(),
                       [&](const auto& entry) { return entry->msg.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(await([&] { return logged(sentence); }));
  EXPECT_FALSE(logged("baud rate"));
}

// A board that prints microseconds where the parameter says milliseconds.
TEST_F(TextDriver, SaysThatTheTimesHaveTheOtherUnit) {
  const auto sketch = plugIn();
  const ros::WallTime start = ros::WallTime::now();
  EXPECT_TRUE(await([&] {
    const auto time = static_cast<std::int64_t>((ros::WallTime::now() - start).toSec() * 1e6);
    sketch->print(std::to_string(time) + ",1,2,3,4,5,6,0\n");
    return diagnostics_.says("fsr/driver: scans", "set text_time to us");
  }));
}

// The sentence with which the node ends on `arguments`.
std::string refusal(const std::string& arguments) {
  ros::param::del("/refused");
  const test_support::ProgramOutput output = test_support::outputOf(
      "rosrun fsr_pressure_map driver_node __name:=refused _protocol:=text " + arguments + " 2>&1");
  EXPECT_EQ(WEXITSTATUS(output.status), 2) << output.text;
  return output.text;
}

TEST(TextDriverParameters, AreRefusedInASentence) {
  const std::string no_rows = refusal("_rows:=0 _columns:=10");
  EXPECT_TRUE(test_support::holds(
      no_rows, {"parameter /refused/rows is 0, but must be 1 or more with the protocol text, whose "
                "lines do not say the size of the matrix"}));
  const std::string unit = refusal("_rows:=7 _columns:=10 _text_time:=s");
  EXPECT_TRUE(test_support::holds(unit, {"parameter /refused/text_time is s, but must be one of ms, us"}));
  const std::string scale = refusal("_rows:=7 _columns:=10 _text_full_scale:=0");
  EXPECT_TRUE(test_support::holds(
      scale, {"parameter /refused/text_full_scale is 0, but must be a whole number, 1 to 65535"}));
}

}  // namespace
