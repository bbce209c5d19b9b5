#include "conductor/session_files.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::conductor {

namespace fs = std::filesystem;

namespace {

constexpr char kState[] = "_session.yaml", kPart[] = "_part", kBag[] = ".bag";

// Letters, digits, - and _ of a name; everything else may mean something in a path.
std::string plainName(std::string name) {
  for (char& one : name) {
    const bool plain = (one >= 'a' && one <= 'z') || (one >= 'A' && one <= 'Z') || (one >= '0' && one <= '9');
    if (!plain && one != '-' && one != '_') one = '_';
  }
  return name;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// 1 of "STEM.bag", 2 of "STEM_part2.bag"; 0 = no bag of this mount.
unsigned long partOf(const std::string& file, const std::string& stem) {
  if (file == stem + kBag) return 1;
  const std::string begin = stem + kPart;
  if (file.compare(0, begin.size(), begin) != 0 || !endsWith(file, kBag)) return 0;
  const std::string number = file.substr(begin.size(), file.size() - begin.size() - (sizeof kBag - 1));
  constexpr std::size_t kMostDigits = 9;
  const bool valid = !number.empty() && number.size() <= kMostDigits &&
                     number.find_first_not_of("0123456789") == std::string::npos;
  return valid ? std::stoul(number) : 0;
}

}  // namespace

std::string stateFileName(const std::string& plan) {
  return plainName(plan) + kState;
}

std::string planFileName(const std::string& plan) {
  return plainName(plan) + "_plan.yaml";
}

std::string reportFileName(const std::string& plan) {
  return plainName(plan) + "_report.html";
}

std::string calibrationFileName(const std::string& plan) {
  return plainName(plan) + "_calibration.h5";
}

std::string resultsFolderName(const std::string& plan) {
  return plainName(plan) + "_report";
}

std::string bagStem(const std::string& plan, unsigned mount, const std::string& surface) {
  return plainName(plan) + "_" + (mount < 10 ? "0" : "") + std::to_string(mount) + "_" + plainName(surface);
}

std::string freeBagName(const std::string& folder, const std::string& stem) {
  const std::string name = (fs::path(folder) / stem).string();
  for (int part = 1;; ++part) {
    const std::string one = name + (part == 1 ? "" : kPart + std::to_string(part));
    if (!fs::exists(one + kBag) && !fs::exists(one + kBag + ".active")) return one;
  }
}

std::vector<std::string> bagsOfMount(const std::string& folder, const std::string& stem) {
  std::map<unsigned long, std::string> parts;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string file = entry.path().filename().string();
    const unsigned long part = partOf(file, stem);
    if (part > 0) parts[part] = file;
  }
  std::vector<std::string> files;
  for (const auto& [part, file] : parts) files.push_back(file);
  return files;
}

std::string stateFileIn(const std::string& folder, const std::string& plan) {
  if (!fs::is_directory(folder)) throw settings::InputError(folder + ": there is no such folder");
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (plan.empty() ? endsWith(file, kState) : file == stateFileName(plan)) found.push_back(file);
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) {
    throw settings::InputError(folder + ": has no " +
                               (plan.empty() ? "*" + std::string(kState) : stateFileName(plan)) +
                               ", which session.launch writes; give the folder of a conducted session");
  }
  if (found.size() > 1) {
    throw settings::InputError(folder + ": has the sessions " + found[0] + " and " + found[1] +
                               "; say which with --plan");
  }
  return found.front();
}

}  // namespace fsr::conductor
