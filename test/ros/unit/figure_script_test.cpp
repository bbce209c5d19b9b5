#include "ros/tools/tool_options.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"
#include "support/holds.h"

namespace {

class FigureScript : public test_support::FolderTest {
 protected:
  std::string script(const std::string& text) {
    const std::string file = path("a script.py");
    std::ofstream(file) << text;
    return file;
  }
  std::string refusal(const std::string& file) {
    return test_support::refusal([&] { fsr_ros::runPython(file, {}); }, "not refused");
  }
};

TEST_F(FigureScript, GetsItsArgumentsUnchanged) {
  const std::string out = path("out");
  fsr_ros::runPython(script("import sys; open(sys.argv[1], 'w').write(sys.argv[2])"),
                     {out, "$HOME; `ls` \"x\""});
  std::string line;
  std::getline(std::ifstream(out), line);
  EXPECT_EQ(line, "$HOME; `ls` \"x\"");
}

TEST_F(FigureScript, SaysWhyItFailed) {
  const std::string message =
      refusal(script("print('drawing')\nraise SystemExit('results.json: no key rows')"));
  EXPECT_NE(message.find("results.json: no key rows"), std::string::npos) << message;
}

// More than the buffer of a pipe: waiting for the end before reading would block for ever.
TEST_F(FigureScript, MayPrintMuch) {
  EXPECT_EQ(refusal(script("print('x' * 300000)\nprint('y\\n' * 100000)")), "not refused");
}

TEST_F(FigureScript, IsNamedWhereItIsMissing) {
  EXPECT_NE(refusal(path("none.py")).find("none.py"), std::string::npos);
}

TEST_F(FigureScript, IsFoundInThePackage) {
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { fsr_ros::drawFigures("no_such_figure.py", {}); }),
                          {"/scripts/figures/no_such_figure.py"}));
}

}  // namespace
