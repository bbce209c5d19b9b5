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

// The current time in UTC, in the format of ISO 8601.
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
    // One short line in one write, so that programs running at the same time do not mix their lines.
    std::ofstream ledger(path, std::ios::app);
    ledger << now() + " seed " + std::to_string(seed) + "\n" << std::flush;
    if (!ledger) {
      throw fsr::settings::InputError(
          path +
          ": cannot be written, but it counts how often the hold-out cycles of the bag "
          "were used; set ROS_HOME to a folder that can be written");
    }
  }
  std::ifstream lines(path);
  return static_cast<int>(
      std::count(std::istreambuf_iterator<char>(lines), std::istreambuf_iterator<char>(), '\n'));
}

}  // namespace fsr_ros
