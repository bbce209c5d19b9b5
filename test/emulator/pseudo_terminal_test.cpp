#include "emulator/pseudo_terminal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "support/pty.h"

namespace {

using fsr::emulator::PseudoTerminal;
using Outcome = PseudoTerminal::Outcome;

/// A program that opens the port and changes no setting.
class PlainReader {
 public:
  explicit PlainReader(const std::string& port) : descriptor_(open(port.c_str(), O_RDWR | O_NOCTTY)) {}
  ~PlainReader() { close(descriptor_); }
  /// The bytes that arrive within a tenth of a second, "" where none do.
  std::string read() {
    pollfd event = {descriptor_, POLLIN, 0};
    if (poll(&event, 1, 100) <= 0) return "";
    char bytes[4096];
    const ssize_t size = ::read(descriptor_, bytes, sizeof(bytes));
    return {bytes, static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
  }

 private:
  int descriptor_;
};

Outcome write(PseudoTerminal& port, const std::string& text) {
  return port.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

TEST(PseudoTerminal, PassesEveryByteUnchangedToAReaderThatSetsNothing) {
  PseudoTerminal port("", 115200);
  PlainReader reader(port.path());
  const std::string bytes("\x03\x04\r\n\x11\x13\x1a\xff\0x",
                          10);  // all bytes that a terminal would interpret
  EXPECT_EQ(write(port, bytes), Outcome::kSent);
  EXPECT_EQ(reader.read(), bytes);
}

TEST(PseudoTerminal, KnowsWhetherAReaderHasItOpen) {
  PseudoTerminal port("", 115200);
  EXPECT_FALSE(port.hasReader());
  EXPECT_EQ(write(port, "x"), Outcome::kUnheard);
  {
    PlainReader reader(port.path());
    EXPECT_TRUE(port.hasReader());
  }
  EXPECT_FALSE(port.hasReader());
}

TEST(PseudoTerminal, DropsWhatTheLastReaderDidNotRead) {
  PseudoTerminal port("", 115200);
  {
    PlainReader careless(port.path());
    EXPECT_EQ(write(port, "left over"), Outcome::kSent);
  }
  EXPECT_FALSE(port.hasReader());
  PlainReader next(port.path());
  EXPECT_EQ(write(port, "fresh"), Outcome::kSent);
  EXPECT_EQ(next.read(), "fresh");
}

TEST(PseudoTerminal, DropsWholePacketsWhereTheReaderIsTooSlow) {
  PseudoTerminal port("", 115200);
  PlainReader reader(port.path());
  const std::string packet = std::string(999, 'x') + "\n";
  int sent = 0;
  while (write(port, packet) == Outcome::kSent) ++sent;
  EXPECT_GT(sent, 3);
  EXPECT_EQ(write(port, packet), Outcome::kFull);
  std::size_t read = 0;
  for (std::string bytes = reader.read(); !bytes.empty(); bytes = reader.read()) {
    read += bytes.size();
    port.waitForRoom(std::chrono::milliseconds(0));
  }
  EXPECT_TRUE(port.waitForRoom(std::chrono::milliseconds(1000)));
  EXPECT_EQ(write(port, "last"), Outcome::kSent);
  for (std::string bytes = reader.read(); !bytes.empty(); bytes = reader.read()) read += bytes.size();
  EXPECT_EQ(read, 1000u * static_cast<std::size_t>(sent) + 4u) << "all packets sent were received completely";
}

TEST(PseudoTerminal, CreatesItsLinkAndRemovesItAtTheEnd) {
  const test_support::TemporaryFolder folder;
  const std::string link = folder.path("board");
  {
    PseudoTerminal first(link, 115200);
    EXPECT_EQ(first.path(), link);
    PseudoTerminal second(link, 115200);  // replaces the link
    PlainReader reader(link);
    EXPECT_TRUE(second.hasReader());
    EXPECT_FALSE(first.hasReader());
  }
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
}

TEST(PseudoTerminal, ReportsTheSpeedThatItsReaderSets) {
  PseudoTerminal port("", 250000);
  EXPECT_EQ(port.readerBaud(), 250000u);
}

}  // namespace
