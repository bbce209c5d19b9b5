// The file of a mask:
//
//     format: fsr_pressure_map mask 1
//     mask: [0, 0, 1, ...]    # one for each taxel, row-major; 1 = masked

#include "ros/bags/mask_file.h"

#include <filesystem>

#include "settings/replace_file.h"
#include "settings/settings.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr char kMaskFormat[] = "fsr_pressure_map mask 1";

}  // namespace

void saveMask(const std::vector<std::uint8_t>& mask, const std::string& path) {
  if (path.empty()) return;
  std::string list;
  for (const std::uint8_t masked : mask)
    list += (list.empty() ? "" : ", ") + std::string(masked != 0 ? "1" : "0");
  std::error_code ignored;  // an error in the folder shows when the file is written
  fs::create_directories(fs::path(path).parent_path(), ignored);
  fsr::settings::replaceFile(path, std::string("format: ") + kMaskFormat + "\nmask: [" + list + "]\n");
}

std::vector<std::uint8_t> loadMask(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return {};
  const auto settings = fsr::settings::Settings::fromFile(path);
  settings.choice("format", {kMaskFormat});
  std::vector<std::uint8_t> mask;
  for (const double value : settings.numbers("mask", {0, 1, ""})) mask.push_back(value != 0 ? 1 : 0);
  settings.refuseUnknown();
  return mask;
}

}  // namespace fsr_ros
