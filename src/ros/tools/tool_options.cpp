#include "ros/tools/tool_options.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_walk.h"
#include "settings/progress.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCountsInMemory = 8u << 20;  // of a bag [bytes]

bool comesFirst(const fs::path& a, const fs::path& b) {
  const double first = std::atof(a.filename().c_str()), second = std::atof(b.filename().c_str());
  return first != second ? first < second : a < b;
}

}  // namespace

ToolProgress toolProgress() {
  return [progress = std::make_shared<fsr::settings::Progress>()](const std::string& step, double share) {
    progress->report(step, share);
  };
}

unsigned threadsOf(const fsr::settings::CommandLine& line) {
  return static_cast<unsigned>(line.integer("threads", 0, {0, 1024, ""}));
}

std::string outputFolder(const std::string& path) {
  const fs::path folder = fs::absolute(path).lexically_normal();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw fsr::settings::InputError(folder.string() + ": the folder cannot be created (" + error.message() +
                                    "); give another one with --output");
  }
  return folder;
}

std::string shellWord(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/' || c == '+' || c == ',' ||
           c == '=';
  });
  if (plain) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line) {
  BagReadOptions how;
  how.counts_in_memory = kCountsInMemory;
  how.topics = line.text("namespace", "");
  if (line.has("ambient")) how.ambient_pressure = line.number("ambient", 0, {0, 120e3, "Pa"});
  return how;
}

std::vector<fsr::dataset::Recording> readBags(const fsr::settings::CommandLine& line,
                                              const std::vector<std::string>& bags) {
  BagReadOptions options = bagReadOptions(line);
  const ToolProgress progress = toolProgress();
  std::vector<fsr::dataset::Recording> recordings;
  for (const std::string& bag : bags) {
    options.progress = told("reading " + bag, progress);
    recordings.push_back(readBag(bag, options));
  }
  return recordings;
}

std::vector<std::string> bagsIn(const std::vector<std::string>& paths) {
  std::vector<std::string> bags;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      bags.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(path)) {
      if (entry.path().extension() == ".bag") inside.push_back(entry.path());
    }
    if (inside.empty()) throw fsr::settings::InputError(path + ": holds no file that ends with .bag");
    std::sort(inside.begin(), inside.end(), comesFirst);
    bags.insert(bags.end(), inside.begin(), inside.end());
  }
  return bags;
}

}  // namespace fsr_ros
