#include "ros/messages/message_reader.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"

namespace {

// A definition with constants, comments, arrays and messages in arrays of messages.
const char* const kDefinition = R"(# A test.
uint8 OK=0
string NAME=a#b
Header header   # when
float32[] values  # [Pa], row-major
int16[3] triple
Pair[] pairs
bool last
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
================================================================================
MSG: test/Pair
string key
string[] words
)";

fsr_ros::MessageType type() {
  return fsr_ros::parseMessageType("test/Everything", kDefinition);
}

std::string number(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string text(const std::string& text) {
  return number(static_cast<std::uint32_t>(text.size())) + text;
}

std::string message() {
  const std::string header = number(1) + number(2) + number(3) + text("frame");
  const std::string values = number(2) + number(0x3f800000) + number(0x40000000);
  const std::string pairs = number(2) + text("a") + number(1) + text("x") + text("b") + number(0);
  return header + values + std::string(6, '\1') + pairs + std::string(1, '\1');
}

TEST(MessageType, RefusesEveryTruncationAndEveryExcess) {
  const std::string whole = message();
  EXPECT_TRUE(fsr_ros::isMessageOf(type(), whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(fsr_ros::isMessageOf(type(), whole.substr(0, size))) << size;
  }
  EXPECT_FALSE(fsr_ros::isMessageOf(type(), whole + '\0'));
}

TEST(MessageType, RefusesAnArrayThatStatesMoreValuesThanThereAre) {
  std::string lying = message();
  const std::size_t at = number(1).size() * 4 + 5;  // the length of `values`
  lying.replace(at, 4, number(0xffffffff));
  EXPECT_FALSE(fsr_ros::isMessageOf(type(), lying));
}

TEST(MessageType, RefusesATypeThatIsMissingOrContainsItself) {
  EXPECT_THROW(fsr_ros::parseMessageType("test/A", "B b\n"), fsr::settings::InputError);
  EXPECT_THROW(fsr_ros::parseMessageType("test/A", "A[] a\n"), fsr::settings::InputError);
  EXPECT_THROW(fsr_ros::parseMessageType("test/A", "uint8\n"), fsr::settings::InputError);
}

}  // namespace
