#include "protocol/serial_port.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "support/holds.h"
#include "support/pty.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

constexpr milliseconds kLong(5000);  // never reached where the code is right
constexpr std::uint32_t kBaud = 115200;

std::int64_t noTime() {
  return 42;
}

// The message of the exception that the constructor throws; empty where it does not throw.
std::string complaintAt(const std::string& path) {
  try {
    fsr::protocol::SerialPort port(path, kBaud, noTime);
    return "";
  } catch (const fsr::protocol::LinkError& error) {
    return error.what();
  }
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class SerialPort : public testing::Test {
 protected:
  test_support::TemporaryFolder folder_;
  std::string link_ = folder_.path("ttyBoard");
  std::unique_ptr<test_support::Pty> board_ = std::make_unique<test_support::Pty>(link_);
};

TEST_F(SerialPort, ReadsBytesAsTheyWereSentWithTheirTime) {
  fsr::protocol::SerialPort port(link_, kBaud, noTime);
  Bytes all(256);  // every value: XON, XOFF, CR, NUL, DEL ... must pass unchanged
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  ASSERT_TRUE(board_->write(all));
  Bytes received;
  Bytes buffer(4096);
  while (received.size() < all.size()) {
    const fsr::protocol::Chunk chunk = port.read(buffer.data(), buffer.size(), kLong);
    ASSERT_GT(chunk.size, 0U);
    EXPECT_EQ(chunk.receive_time, 42);
    received.insert(received.end(), buffer.begin(), buffer.begin() + chunk.size);
  }
  EXPECT_EQ(received, all);
}

TEST_F(SerialPort, ReturnsWithoutBytesWhenTheBoardIsSilent) {
  fsr::protocol::SerialPort port(link_, kBaud, noTime);
  Bytes buffer(16);
  EXPECT_EQ(port.read(buffer.data(), buffer.size(), milliseconds(1)).size, 0U);
}

TEST_F(SerialPort, SaysThatTheBoardWasUnplugged) {
  fsr::protocol::SerialPort port(link_, kBaud, noTime);
  board_.reset();
  Bytes buffer(16);
  try {
    port.read(buffer.data(), buffer.size(), kLong);
    FAIL() << "no complaint";
  } catch (const fsr::protocol::LinkError& error) {
    EXPECT_TRUE(contains(error.what(), link_ + " was unplugged or switched off")) << error.what();
  }
}

TEST_F(SerialPort, SetsNamedAndUnnamedSpeedsAndKeepsThePortsSpeedAtZero) {
  for (const std::uint32_t baud : {9600U, 115200U, 921600U, 250000U, 1234567U}) {
    fsr::protocol::SerialPort port(link_, baud, noTime);
    EXPECT_EQ(board_->speed(), baud);
  }
  fsr::protocol::SerialPort port(link_, 0, noTime);
  EXPECT_EQ(board_->speed(), 1234567U);
}

TEST_F(SerialPort, HasNoBaudForAPseudoTerminal) {
  EXPECT_EQ(fsr::protocol::SerialPort(link_, kBaud, noTime).baud(), 0U);
}

TEST_F(SerialPort, RefusesASecondReaderAndSaysHowToFindTheFirst) {
  const fsr::protocol::SerialPort first(link_, kBaud, noTime);
  const std::string complaint = complaintAt(link_);
  EXPECT_TRUE(contains(complaint, "another program has " + link_ + " open")) << complaint;
  EXPECT_TRUE(contains(complaint, "fuser -v " + link_)) << complaint;
}

TEST_F(SerialPort, NamesAMissingPortAndWhatToSet) {
  const std::string complaint = complaintAt(folder_.path("ttyNone"));
  EXPECT_TRUE(contains(complaint, "there is no serial port " + folder_.path("ttyNone"))) << complaint;
  EXPECT_TRUE(contains(complaint, "plug the board in")) << complaint;
  EXPECT_TRUE(contains(complaint, "No such file or directory")) << complaint;
}

TEST_F(SerialPort, RefusesAFileThatIsNotAPort) {
  std::ofstream(folder_.path("notes.txt")) << "no port";
  EXPECT_TRUE(contains(complaintAt(folder_.path("notes.txt")), "notes.txt is not a serial port"));
  EXPECT_TRUE(contains(complaintAt(folder_.path()), "is not a serial port"));
}

TEST_F(SerialPort, NamesTheGroupAndTheCommandWhereThePermissionIsMissing) {
  const std::string complaint = fsr::protocol::explainOpenError("/dev/ttyNone", EACCES);
  EXPECT_TRUE(test_support::holds(
      complaint, {"/dev/ttyNone", "group dialout", "'sudo usermod -aG dialout $USER'", "Permission denied"}));
}

TEST_F(SerialPort, ListsStableNamesFirst) {
  std::filesystem::create_directories(folder_.path("dev/serial/by-id"));
  for (const char* name : {"ttyUSB1", "ttyACM0", "ttyUSB0", "ttyS0", "null", "serial/by-id/usb-board-if00"}) {
    std::ofstream(folder_.path("dev/") + name) << "";
  }
  const std::string dev = folder_.path("dev");
  const std::vector<std::string> expected = {dev + "/serial/by-id/usb-board-if00", dev + "/ttyACM0",
                                             dev + "/ttyUSB0", dev + "/ttyUSB1"};
  EXPECT_EQ(fsr::protocol::serialPortCandidates(dev), expected);
  EXPECT_TRUE(fsr::protocol::serialPortCandidates(folder_.path("nowhere")).empty());
}

}  // namespace
