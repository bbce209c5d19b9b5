#include "settings/regular_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/replace_file.h"
#include "support/pty.h"

namespace fsr::settings {
namespace {

void write(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

TEST(FileKind, IsToldByTheFirstBytes) {
  EXPECT_EQ(kindOf("#ROSBAG V2.0\nE"), "a bag");
  EXPECT_EQ(kindOf("fsr_pressure_map calibration schema=8 sha256="), "a calibration");
  EXPECT_EQ(kindOf("{\"a\": 1}"), "a JSON file");
  EXPECT_EQ(kindOf("<!DOCTYPE html>"), "a web page");
  EXPECT_EQ(kindOf("# remark: x\n\ntime [s],reading\n1,2\n"), "a table of values");
  EXPECT_EQ(kindOf("# remark\nplan: monday\nsurfaces: []\n"), "a YAML file of the kind plan");
  EXPECT_EQ(kindOf("sheet:\n  a: 1\n"), "a YAML file of the kind sheet");
  EXPECT_EQ(kindOf("format: fsr_pressure_map mask 1\nmask: [0]\n"), "a fsr_pressure_map mask");
  EXPECT_EQ(kindOf("Dear Sir or Madam"), "a text");
  EXPECT_EQ(kindOf(std::string("\0\0\0\x20"
                               "ftypisom",
                               12)),
            "a movie (mp4)");
  EXPECT_EQ(kindOf(std::string("\1\0\2", 3)), "a file of an unknown kind");
  EXPECT_EQ(kindOf("# only a remark"), "a text");
  EXPECT_EQ(kindOf(""), "");
}

TEST(FileKind, OnlyAFileOfTheKindThatIsWrittenIsReplaced) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder.path("precious.bag");
  write(path, "#ROSBAG V2.0\n");
  const std::string refused =
      path + ": is a bag, which is not replaced by a JSON file; give another name for the output";
  const auto expectRefused = [&](const std::function<void()>& attempt) {
    try {
      attempt();
      ADD_FAILURE() << "written";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), refused);
    }
    EXPECT_EQ(kindOfFile(path), "a bag");
  };
  expectRefused([&] { requireReplaceable(path, file_kind::kJson); });
  expectRefused([&] { replaceFile(path, "{}"); });
  expectRefused([&] { FreshPath(path, file_kind::kJson); });
  expectRefused([&] {
    FreshFile file(path);  // what will be written is not known yet
    file.write("{}");
    file.finish();
  });
  replaceFile(path, "#ROSBAG V2.0\nnew");
  write(path, "");
  replaceFile(path, "{}");
  EXPECT_EQ(kindOfFile(path), "a JSON file");
}

}  // namespace
}  // namespace fsr::settings
