#include "session/session_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/plan.h"
#include "settings/replace_file.h"
#include "settings/settings.h"
#include "settings/sha256.h"
#include "settings/text.h"

namespace fsr::session {

namespace fs = std::filesystem;
using boost::ends_with;

namespace {

constexpr char kPart[] = "_part", kBag[] = ".bag";
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

// Names of the files in a folder for which `wanted` holds, sorted.
template <typename Wanted>
std::vector<std::string> filesIn(const std::string& folder, Wanted wanted) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string file = entry.path().filename().string();
    if (wanted(file)) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
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
  if (file.compare(0, begin.size(), begin) != 0 || !ends_with(file, kBag)) return 0;
  const std::string number = file.substr(begin.size(), file.size() - begin.size() - (sizeof kBag - 1));
  constexpr std::size_t kMostDigits = 9;
  const bool valid = !number.empty() && number.size() <= kMostDigits &&
                     number.find_first_not_of("0123456789") == std::string::npos;
  return valid ? std::stoul(number) : 0;
}

}  // namespace

std::string sessionFile(const std::string& plan, const char* ending, const std::string& folder) {
  return (fs::path(folder) / (plainName(plan) + ending)).string();
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
  std::vector<std::string> files = filesIn(folder, [&](const auto& file) { return partOf(file, stem) > 0; });
  std::sort(files.begin(), files.end(),
            [&](const std::string& a, const std::string& b) { return partOf(a, stem) < partOf(b, stem); });
  return files;
}

std::vector<std::string> openBags(const std::string& folder, const std::string& plan) {
  return filesIn(folder, [&](const std::string& file) {
    return file.rfind(plainName(plan) + "_", 0) == 0 && ends_with(file, std::string(kBag) + kOpen);
  });
}

std::vector<MovedBag> setMountAside(const std::string& folder, const std::string& stem) {
  const auto files = filesIn(folder, [&](const std::string& file) {
    const std::string closed =
        ends_with(file, kOpen) ? file.substr(0, file.size() - (sizeof kOpen - 1)) : file;
    return partOf(closed, stem) > 0;
  });
  std::vector<MovedBag> moved;
  for (const std::string& file : files)
    moved.push_back(moveInto(fs::path(folder) / kSetAside, fs::path(folder) / file));
  return moved;
}

std::string stateFileIn(const std::string& folder, const std::string& plan) {
  if (!fs::is_directory(folder)) throw settings::InputError(folder + ": there is no such folder");
  const auto found = filesIn(folder, [&](const std::string& file) {
    return plan.empty() ? ends_with(file, kStateFile) : file == sessionFile(plan, kStateFile);
  });
  if (found.empty()) {
    throw settings::InputError(
        folder + ": has no " +
        (plan.empty() ? "*" + std::string(kStateFile) : sessionFile(plan, kStateFile)) +
        ", which session.launch writes; give the folder of a conducted session");
  }
  if (found.size() > 1) {
    throw settings::InputError(folder + ": has the sessions " + found[0] + " and " + found[1] +
                               "; say which with --plan");
  }
  return found.front();
}

FolderLock::FolderLock(const std::string& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw settings::InputError(
      folder + ": another conductor leads a session in this folder; end it, or give another folder");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

namespace {

std::string remarksText(const std::vector<StepRemark>& remarks) {
  std::string text;
  for (const StepRemark& remark : remarks) {
    const std::string reason = remark.reason == Reason::kNone ? "" : ", reason: " + name(remark.reason);
    text += "  - {step: " + std::to_string(remark.step + 1) + reason +
            ", sentence: " + settings::quotedText(remark.sentence) + "}\n";
  }
  return text.empty() ? "" : "remarks:\n" + text;
}

Reason reasonCalled(const settings::Settings& entry) {
  if (!entry.has("reason")) return Reason::kNone;
  std::vector<std::string> names;
  for (const Reason reason : dataset::allRejectReasons()) names.push_back(name(reason));
  const std::string called = entry.choice("reason", names);
  return dataset::allRejectReasons()[static_cast<std::size_t>(std::find(names.begin(), names.end(), called) -
                                                              names.begin())];
}

std::vector<StepRemark> readRemarks(const settings::Settings& settings, std::size_t steps) {
  std::vector<StepRemark> remarks;
  if (!settings.has("remarks")) return remarks;
  const settings::Range range{1, static_cast<double>(std::max<std::size_t>(steps, 1)), ""};
  for (const settings::Settings& entry : settings.sections("remarks")) {
    const auto step = static_cast<std::size_t>(entry.integer("step", range));
    remarks.push_back({step - 1, reasonCalled(entry), entry.text("sentence")});
  }
  return remarks;
}

// The digest of a state was that of the plan's text, as it was worded then. It is beside the state, below a
// remark of one line.
std::string digestOfContent(const std::string& digest, const std::string& plan) {
  std::ifstream file(plan, std::ios::binary);
  std::string remark;
  std::getline(file, remark);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (text.empty() || settings::sha256(text.data(), text.size()) != digest) return digest;
  return digestOf(readPlanFile(plan));
}

}  // namespace

void writeState(const std::string& path, const ConductorState& state) {
  std::string steps;
  for (const StepState one : state.steps) steps += static_cast<char>(one);
  settings::replaceFile(
      path, "# A session that conduct goes on with.\nplan: " + settings::quotedText(state.plan) +
                "\ndigest: " + settings::quotedText(state.digest) + "\ntime: " +
                settings::numberText(state.time) + "\nrejected: " + std::to_string(state.rejected) +
                "\nsteps: " + settings::quotedText(steps) + "\n" + remarksText(state.remarks));
}

ConductorState readState(const std::string& path) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  ConductorState state;
  state.plan = settings.text("plan");
  state.digest = digestOfContent(settings.text("digest"),
                                 sessionFile(state.plan, kPlanFile, fs::path(path).parent_path().string()));
  state.time = settings.number("time", {0, 1e12, "s"});
  state.rejected = static_cast<unsigned>(settings.integer("rejected", {0, 1e9, "attempts"}));
  for (const char one : settings.text("steps")) {
    if (one != '.' && one != 'a' && one != 's') {
      throw settings.error("steps", "must consist of a (accepted), s (skipped) and . (open)");
    }
    state.steps.push_back(static_cast<StepState>(one));
  }
  state.remarks = readRemarks(settings, state.steps.size());
  settings.refuseUnknown();
  return state;
}

}  // namespace fsr::session
