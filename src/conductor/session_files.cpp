#include "conductor/session_files.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::conductor {

namespace fs = std::filesystem;

namespace {

constexpr char kState[] = "_session.yaml", kPart[] = "_part", kBag[] = ".bag";
constexpr char kOpen[] = ".active";        // behind the name of a bag that is being written
constexpr char kSetAside[] = "set_aside";  // folder of bags that do not count

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

MovedBag moveInto(const fs::path& folder, const fs::path& bag) {
  fs::path kept = folder / bag.filename();
  for (int copy = 2; fs::exists(kept); ++copy)
    kept = folder / ("copy" + std::to_string(copy) + "_" + bag.filename().string());
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!failed) fs::rename(bag, kept, failed);
  return {bag.string(), kept.string(), failed ? failed.message() : ""};
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
    if (!fs::exists(one + kBag) && !fs::exists(one + kBag + kOpen)) return one;
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

std::vector<std::string> openBags(const std::string& folder, const std::string& plan) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string file = entry.path().filename().string();
    if (file.rfind(plainName(plan) + "_", 0) == 0 && endsWith(file, std::string(kBag) + kOpen))
      files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<MovedBag> setMountAside(const std::string& folder, const std::string& stem) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string file = entry.path().filename().string();
    const std::string closed =
        endsWith(file, kOpen) ? file.substr(0, file.size() - (sizeof kOpen - 1)) : file;
    if (partOf(closed, stem) > 0) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  std::vector<MovedBag> moved;
  for (const std::string& file : files)
    moved.push_back(moveInto(fs::path(folder) / kSetAside, fs::path(folder) / file));
  return moved;
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
