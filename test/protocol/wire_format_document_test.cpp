#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "fsr_pressure_map/protocol/wire.h"
#include "support/content_of.h"
#include "support/link_rate.h"
#include "support/program_output.h"
#include "support/pty.h"
#include "support/source_dir.h"

// Compares docs/wire_format.md and docs/boards.md with the code.
namespace {

const std::string kSource = test_support::sourceDir();

std::string document(const std::string& name) {
  return test_support::contentOf(kSource + "/docs/" + name);
}

// Text between the first `start` behind `heading` and the next `end`.
std::string between(const std::string& heading, const std::string& start, const std::string& end,
                    const std::string& name = "wire_format.md") {
  const std::string text = document(name);
  const std::size_t from = text.find(start, text.find(heading));
  if (from == std::string::npos) return "";
  const std::size_t first = from + start.size();
  return text.substr(first, text.find(end, first) - first);
}

TEST(WireFormatDocument, ShowsTheBytesThatTheEncoderMakes) {
  std::istringstream words(between("## Example", "```\n", "```"));
  std::vector<unsigned> shown;
  for (std::string word; words >> word;)
    shown.push_back(static_cast<unsigned>(std::stoul(word, nullptr, 16)));

  const std::array<std::uint16_t, 6> counts = {0, 1, 258, 2730, 4094, 4095};
  const fsr_wire_scan scan = {2, 3, 4095, 5000, counts.data()};
  std::array<std::uint8_t, 64> packet{};
  const std::size_t size = fsr_wire_encode_scan(packet.data(), packet.size(), 7, 123456789, &scan);
  EXPECT_EQ(shown, std::vector<unsigned>(packet.begin(), packet.begin() + size));
}

struct LinkBudget {
  std::string name;
  double bytes_per_second;
};

// Follows docs/boards.md to the letter: copies both files into one folder, compiles the program that it shows
// with the command that it shows, and compares the output with the packet of docs/wire_format.md.
TEST(BoardsDocument, ShowsAProgramThatPrintsTheExampleWhereBothFilesAreCopied) {
  const std::string heading = "## Testing the encoder";
  const test_support::TemporaryFolder firmware;
  std::ofstream(firmware.path("check.c")) << between(heading, "```c\n", "```", "boards.md");
  const std::string command = between(heading, "    gcc ", "\n", "boards.md");
  ASSERT_NE(command, "");
  const test_support::ProgramOutput printed = test_support::outputOf(
      "cp " + kSource + "/include/fsr_pressure_map/protocol/wire.h " + kSource + "/src/protocol/wire.c " +
      firmware.path() + " && cd " + firmware.path() + " && gcc " + command + " 2>&1");
  EXPECT_EQ(printed.status, 0) << printed.text;
  std::string expected = between("## Example", "```\n", "```");
  std::replace(expected.begin(), expected.end() - 1, '\n', ' ');
  EXPECT_EQ(printed.text, expected);
}

TEST(WireFormatDocument, ShowsTheScanRatesThatTheFormulaGives) {
  const std::vector<LinkBudget> links = {{"115200 baud", test_support::serialBytesPerSecond(115200)},
                                         {"230400 baud", test_support::serialBytesPerSecond(230400)},
                                         {"921600 baud", test_support::serialBytesPerSecond(921600)},
                                         {"USB full speed", test_support::kUsbFullSpeedBytesPerSecond}};
  std::ostringstream expected;
  for (const LinkBudget& link : links) {
    expected << "| " << link.name << " | "
             << std::floor(test_support::scanRate(link.bytes_per_second, {7, 10})) << " | "
             << std::floor(test_support::scanRate(link.bytes_per_second, {16, 10})) << " |\n";
  }
  EXPECT_EQ(between("## How fast", "|---|---:|---:|\n", "\n\n") + "\n", expected.str());
}

// By hand: 7 x 10 makes 20 + 8 + 140 = 168 bytes a scan and 24 a reading; identity and temperature 76 + 24 a
// second. 115200 baud carry 11,520 bytes a second: (11,520 - 100) / 192 = 59.479.
TEST(ScanRate, MatchesACountByHand) {
  EXPECT_NEAR(test_support::scanRate(test_support::serialBytesPerSecond(115200), {7, 10}), 59.479, 0.001);
  EXPECT_EQ(test_support::scanRate(90, {7, 10}), 0);
}

}  // namespace
