#include "ros/tools/tool_options.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace {

class FigureScript : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "figure_script_" + std::to_string(::getpid()) + "/";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string script(const std::string& text) {
    const std::string path = folder_ + "a script.py";
    std::ofstream(path) << text;
    return path;
  }
  std::string refusal(const std::string& path) {
    try {
      fsr_ros::runPython(path, {});
    } catch (const fsr::settings::InputError& error) {
      return error.what();
    }
    return "not refused";
  }
  std::string folder_;
};

TEST_F(FigureScript, GetsItsArgumentsUnchanged) {
  const std::string out = folder_ + "out";
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
  EXPECT_NE(refusal(folder_ + "none.py").find("none.py"), std::string::npos);
}

TEST_F(FigureScript, IsFoundInThePackage) {
  try {
    fsr_ros::drawFigures("no_such_figure.py", {});
    FAIL();
  } catch (const fsr::settings::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/scripts/figures/no_such_figure.py"), std::string::npos)
        << error.what();
  }
}

}  // namespace
