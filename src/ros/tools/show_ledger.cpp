#include "ros/tools/show_ledger.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/resource_path.h"

namespace fsr_ros {

namespace {

// UTC, as ISO 8601 spells it.
std::string now() {
  const std::time_t time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

ShowLedger::ShowLedger() : folder_(rosHome() + "/fsr_pressure_map/show_opened") {}

int ShowLedger::open(const std::string& sha256, std::uint64_t seed) const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const std::string path = folder_ + "/" + sha256;
  {
    // One short line in one write: runs beside each other do not tear it.
    std::ofstream ledger(path, std::ios::app);
    ledger << now() + " seed " + std::to_string(seed) + "\n" << std::flush;
    if (!ledger) {
      throw fsr::settings::InputError(path +
                                      ": cannot be written, but it counts how often the bag was looked at; "
                                      "let ROS_HOME name a folder that can");
    }
  }
  std::ifstream lines(path);
  return static_cast<int>(
      std::count(std::istreambuf_iterator<char>(lines), std::istreambuf_iterator<char>(), '\n'));
}

}  // namespace fsr_ros
