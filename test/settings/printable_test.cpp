#include "settings/text.h"

#include <gtest/gtest.h>

#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/command_line.h"

namespace fsr::settings {
namespace {

TEST(Printable, ReplacesEveryControlCharacterButNewlineAndTab) {
  EXPECT_EQ(printable("a\x1B[31mred\x1B]0;title\a\r\x7F\b"), "a?[31mred?]0;title????");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "31m"),
            "a?31m")
      << "U+009B begins a sequence, too";
  const std::string kept =
      "row\tone\nZylinder 7 cm, gew\xC3\xB6lbt, 20 \xC2\xB5s, \xE2\x82\xAC \xF0\x9F\x99\x82";
  EXPECT_EQ(printable(kept), kept);
  EXPECT_EQ(printable("cut \xC2"), "cut \xC2");
}

TEST(Printable, OutputIsCleanedHoweverItIsWritten) {
  std::ostringstream out;
  {
    const PrintableOutput clean(out);
    out << std::string("a\x1B[2J") << '\x1B' << 12.5 << std::flush << std::endl;
    EXPECT_TRUE(out.good());
  }
  out << '\x1B';
  EXPECT_EQ(out.str(), "a?[2J?12.5\n\x1B");
}

TEST(Printable, ToolsPrintNothingElse) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int status = runTool("tool", []() -> int {
    std::cout << "surface \x1B[31mflat\n";
    throw InputError("\x1B[2J.bag: is no bag");
  });
  EXPECT_EQ(status, 2);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "surface ?[31mflat\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "tool: ?[2J.bag: is no bag\n");
}

}  // namespace
}  // namespace fsr::settings
