// docs/nodes.md has a row for each mistake of the emulated operator, in their order.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "emulator/mistakes.h"
#include "support/source_dir.h"

namespace {

using fsr::emulator::Mistake;
using fsr::emulator::Notice;

std::string reasons(const Mistake& mistake) {
  if (mistake.notice == Notice::kWaiting) return "none: the session waits";
  std::string text = "`";
  for (const char letter : mistake.expected) text += letter == ' ' ? "` or `" : std::string(1, letter);
  return text + "`" + (mistake.notice == Notice::kReadings ? ", only by comparing readings" : "");
}

TEST(MistakesDocument, ListsEveryMistakeWithItsReason) {
  std::string expected =
      "| mistake | the operator | reason that the conductor should give |\n|---|---|---|\n";
  for (const Mistake& mistake : fsr::emulator::mistakes()) {
    expected += "| `" + mistake.name + "` | " + mistake.description + " | " + reasons(mistake) + " |\n";
  }
  std::ifstream file(test_support::sourceDir() + "/docs/nodes.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = text.find("| mistake |");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(text.substr(begin, text.find("<!-- end -->", begin) - begin), expected);
}

}  // namespace
