// Checks every #include of the package: a room may use rooms on lower storeys only. The storeys are those of
// docs/how_it_is_built.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "support/source_dir.h"

namespace {

namespace fs = std::filesystem;

const std::map<std::string, int> kStorey = {
    {"settings", 0},     {"hdf5", 1},       {"matrix", 1},      {"statistics", 1}, {"rheology", 1},
    {"regression", 2},   {"dataset", 2},    {"map", 2},         {"protocol", 2},   {"mesh", 2},
    {"compensation", 3}, {"simulation", 3}, {"health", 3},      {"view", 3},       {"calibration", 4},
    {"emulator", 4},     {"study", 5},      {"discrepancy", 5}, {"check", 5},      {"report", 6},
    {"exports", 6},      {"session", 7},    {"ros", 8},         {"nodes", 9},      {"tools", 9},
};

const fs::path kSource = test_support::sourceDir();

struct Include {
  fs::path file;
  std::string room;    // of the including file
  std::string target;  // as written between the brackets or quotes
};

std::vector<fs::path> sourceFiles() {
  std::vector<fs::path> files;
  for (const fs::path& top : {kSource / "include/fsr_pressure_map", kSource / "src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(top)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  return files;
}

std::string roomOf(const fs::path& file) {
  for (const fs::path& top : {kSource / "include/fsr_pressure_map", kSource / "src"}) {
    const fs::path relative = fs::relative(file, top);
    if (*relative.begin() != "..") return relative.begin()->string();
  }
  return "";
}

std::vector<std::string> includesOf(const fs::path& file) {
  static const std::regex line_pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> targets;
  std::ifstream in(file);
  std::string line;
  std::smatch match;
  while (std::getline(in, line)) {
    if (std::regex_search(line, match, line_pattern)) targets.push_back(match[1]);
  }
  return targets;
}

std::vector<Include> allIncludes() {
  std::vector<Include> includes;
  for (const fs::path& file : sourceFiles()) {
    for (const std::string& target : includesOf(file)) includes.push_back({file, roomOf(file), target});
  }
  return includes;
}

// The room that an include points to, "" for a header from outside the package's rooms. Public headers are
// included as "fsr_pressure_map/room/file.h", those beside their sources as "room/file.h".
std::string targetRoom(const std::string& target) {
  static const std::string prefix = "fsr_pressure_map/";
  const std::size_t begin = target.rfind(prefix, 0) == 0 ? prefix.size() : 0;
  const std::size_t slash = target.find('/', begin);
  if (slash == std::string::npos) return "";
  if (begin == 0 && !fs::exists(kSource / "src" / target)) return "";
  return target.substr(begin, slash - begin);
}

bool isRosHeader(const std::string& target) {
  static const std::regex pattern(
      R"(^(ros|rosbag|nodelet|pluginlib|std_msgs|std_srvs|sensor_msgs|geometry_msgs|visualization_msgs|)"
      R"(diagnostic_msgs|diagnostic_updater|rosgraph_msgs|tf2_ros|topic_tools|rviz)/)"
      R"(|^fsr_pressure_map/[A-Z][A-Za-z]*\.h$)");  // the last: generated messages
  return std::regex_search(target, pattern);
}

TEST(House, EveryFolderIsARoomWithAStorey) {
  for (const fs::path& file : sourceFiles()) EXPECT_EQ(kStorey.count(roomOf(file)), 1u) << file;
}

TEST(House, NoRoomUsesItsOwnStoreyOrAHigherOne) {
  int arrows = 0;
  for (const Include& include : allIncludes()) {
    const std::string target = targetRoom(include.target);
    if (target.empty() || target == include.room) continue;
    ASSERT_EQ(kStorey.count(target), 1u) << include.file << " includes " << include.target;
    EXPECT_LT(kStorey.at(target), kStorey.at(include.room)) << include.file << " includes " << include.target;
    ++arrows;
  }
  EXPECT_GT(arrows, 5);  // includes were found
}

// Tests of a room may use the room itself and lower storeys, so that they build without the storeys above.
TEST(House, TestsOfARoomUseNoHigherRoom) {
  int arrows = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "test")) {
    const std::string room = *std::next(fs::relative(entry.path(), kSource).begin());
    if (!entry.is_regular_file() || kStorey.count(room) == 0) continue;
    for (const std::string& include : includesOf(entry.path())) {
      const std::string target = targetRoom(include);
      if (target.empty()) continue;
      EXPECT_LE(kStorey.at(target), kStorey.at(room)) << entry.path() << " includes " << include;
      ++arrows;
    }
  }
  EXPECT_GT(arrows, 100);
}

// Folders of a room. Each may use only those before it. Files directly in the room's folder may use all of
// them.
const std::map<std::string, std::vector<std::string>> kCorridors = {
    {"ros", {"messages", "bags", "programs", "live", "driver", "recording", "tools"}},
    {"discrepancy", {"samples", "fit", "decide", "prove"}},
};

TEST(House, NoFolderOfARoomUsesALaterOne) {
  int arrows = 0;
  for (const auto& [room, corridors] : kCorridors) {
    for (const std::string& corridor : corridors) {
      EXPECT_TRUE(fs::is_directory(kSource / "src" / room / corridor)) << room << '/' << corridor;
    }
  }
  for (const auto& [room, corridors] : kCorridors) {
    const auto number = [&, &names = corridors](const std::string& corridor) {
      return std::find(names.begin(), names.end(), corridor) - names.begin();
    };
    for (const Include& include : allIncludes()) {
      const fs::path relative = fs::relative(include.file, kSource / "src" / room);
      const fs::path target = fs::path(include.target).lexically_relative(room);
      const auto from = number(relative.begin()->string()), to = number(target.begin()->string());
      if (include.room != room || from == static_cast<std::ptrdiff_t>(corridors.size()) ||
          to == static_cast<std::ptrdiff_t>(corridors.size())) {
        continue;
      }
      EXPECT_LE(to, from) << include.file << " includes " << include.target;
      ++arrows;
    }
  }
  EXPECT_GT(arrows, 100);
}

TEST(House, NoRoomIsTooLarge) {
  std::map<fs::path, int> files;
  for (const fs::path& file : sourceFiles()) ++files[file.parent_path()];
  for (const auto& [folder, count] : files) EXPECT_LE(count, 44) << folder;
}

TEST(House, OnlyTheRoomsOfRosIncludeRos) {
  for (const Include& include : allIncludes()) {
    if (kStorey.at(include.room) >= kStorey.at("ros")) continue;
    EXPECT_FALSE(isRosHeader(include.target)) << include.file << " includes " << include.target;
  }
}

TEST(House, CalibrationNeverUsesTheSimulation) {
  for (const Include& include : allIncludes()) {
    if (include.room != "compensation" && include.room != "calibration") continue;
    EXPECT_NE(targetRoom(include.target), "simulation") << include.file;
  }
}

// Files of the package and its tests that `file` includes directly or indirectly, with the file itself.
void see(const fs::path& file, std::set<fs::path>& seen) {
  if (!fs::exists(file) || !seen.insert(file).second) return;
  for (const std::string& target : includesOf(file)) {
    for (const char* root : {"include", "src", "test"}) see(kSource / root / target, seen);
  }
}

// Data made with the package's own formulas would make its search look too good.
TEST(House, BlindDataUseNoFormulaOfThePackage) {
  std::set<fs::path> seen;
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "test/blind")) {
    if (entry.is_regular_file()) see(entry.path(), seen);
  }
  EXPECT_EQ(seen.count(kSource / "include/fsr_pressure_map/dataset/recording.h"),
            1u);  // indirect includes are found
  for (const fs::path& file : seen) {
    if (fs::relative(file, kSource / "test").begin()->string() != "..") continue;
    for (const char* room : {"simulation", "discrepancy", "rheology", "emulator"}) {
      EXPECT_NE(roomOf(file), room) << "test/blind sees " << file;
    }
  }
}

}  // namespace
