#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "protocol/text_decoder.h"
#include "support/content_of.h"
#include "support/link_rate.h"
#include "support/packet_recorder.h"
#include "support/program_output.h"
#include "support/pty.h"
#include "support/source_dir.h"

// Compares docs/text_format.md and its example sketch with the decoder.
namespace {

const std::string kSketch = test_support::sourceDir() + "/docs/examples/text_board/text_board.ino";

// What the sketch uses of the Arduino library. A taxel reads 100 times its row plus its column, where its row
// alone is driven; the program prints three scans.
const char* const kArduino = R"(
#include <cstdio>
const int LOW = 0, HIGH = 1, OUTPUT = 1, A0 = 54;
int levels[70];
unsigned long now = 4294967290;  // wraps in the second scan
unsigned long millis() { return now += 4, now &= 0xFFFFFFFF; }
void pinMode(int, int) {}
void digitalWrite(int pin, int level) { levels[pin] = level; }
void delayMicroseconds(unsigned) {}
int analogRead(int pin) {
  int row = -1, driven = 0;
  for (int i = 22; i < 29; ++i) if (levels[i] == HIGH) row = i - 22, ++driven;
  return driven == 1 ? 100 * row + pin - A0 : 1023;
}
struct {
  void begin(long) {}
  void print(unsigned long number) { std::printf("%lu", number); }
  void print(int number) { std::printf("%d", number); }
  void print(char c) { std::printf("%c", c); }
  void println(const char* text = "") { std::printf("%s\r\n", text); }
} Serial;
)";

std::vector<std::string> decoded(const std::string& text, const fsr::protocol::DecoderOptions& options) {
  test_support::PacketRecorder recorder;
  fsr::protocol::TextDecoder decoder(recorder, options);
  decoder.feed(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return recorder.lines;
}

TEST(TextFormatDocument, ShowsASketchWhoseLinesTheDriverReadsWithItsDefaults) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.path("main.cpp"))
      << kArduino << "#include \"" << kSketch
      << "\"\nint main() { setup(); for (int i = 0; i < 3; ++i) loop(); }\n";
  const test_support::ProgramOutput printed = test_support::outputOf(
      "cd " + folder.path() + " && g++ -std=c++11 -Wall -Wextra -Werror main.cpp -o sketch 2>&1 && ./sketch");
  ASSERT_EQ(printed.status, 0) << printed.text;

  std::string counts;
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 10; ++column) counts += " " + std::to_string(100 * row + column);
  }
  fsr::protocol::DecoderOptions options;
  options.size = {7, 10};
  std::vector<std::string> expected;
  std::uint32_t time = 4294967290U;
  for (int i = 1; i <= 3; ++i) {
    time += 4;
    expected.push_back("scan #" + std::to_string(i) + " @" + std::to_string(time * 1000U) +
                       " 7x10 full 1023 took 0 counts" + counts);
  }
  EXPECT_EQ(decoded("\n" + printed.text, options), expected);
}

std::string document() {
  return test_support::contentOf(test_support::sourceDir() + "/docs/text_format.md");
}

// The longest line: ten digits of time, four digits and a comma for each count, and "\r\n".
double lineRate(double baud, int taxels) {
  return std::floor(test_support::serialBytesPerSecond(static_cast<std::uint32_t>(baud)) /
                    (10 + 5 * taxels + 2));
}

TEST(TextFormatDocument, ShowsTheRatesOfTheLongestLines) {
  for (const int baud : {115200, 230400, 921600}) {
    std::ostringstream row;
    row << "| " << baud << " baud | " << lineRate(baud, 70) << " | " << lineRate(baud, 160) << " |\n";
    EXPECT_NE(document().find(row.str()), std::string::npos) << row.str();
  }
}

// A line of 70 counts, evenly over the full scale, in which each bit in turn is flipped.
TEST(TextFormatDocument, SaysHowManyFlippedBitsPass) {
  std::string line = "123456";
  for (int i = 0; i < 70; ++i) line += "," + std::to_string(i * 1023 / 69);
  line += "\r\n";
  fsr::protocol::DecoderOptions options;
  options.size = {7, 10};
  const auto sound = decoded("\n" + line, options);
  ASSERT_EQ(sound.size(), 1U);
  int passed = 0, flipped = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit, ++flipped) {
      std::string damaged = line;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      const auto found = decoded("\n" + damaged, options);
      if (!found.empty() && found != sound) ++passed;
    }
  }
  const std::string sentence = std::to_string(std::lround(100.0 * passed / flipped)) + " % pass";
  EXPECT_NE(document().find(sentence), std::string::npos) << sentence << ": " << passed << " of " << flipped;
}

}  // namespace
