#include "ros/tools/bag_options.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/tool_progress.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCountsInMemory = 8u << 20;  // of a bag [bytes]

bool comesFirst(const fs::path& a, const fs::path& b) {
  const double first = std::atof(a.filename().c_str()), second = std::atof(b.filename().c_str());
  return first != second ? first < second : a < b;
}

}  // namespace

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
