#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "check/check.h"
#include "check/sheet_life.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/check_report.h"
#include "report/life/life_report.h"
#include "ros/tools/tool_options.h"
#include "ros/tools/tools.h"
#include "settings/command_line.h"
#include "settings/foreign_error.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

using fsr::settings::CommandLine;
using fsr::settings::InputError;

namespace fs = std::filesystem;
namespace check = fsr::check;
using fsr::calibration::Calibration;

constexpr int kSkipped = 1;  // exit status if a file could not be used

// A bag or calibration file below the folder.
struct FoundFile {
  std::string path;
  std::string shown;  // relative to the folder
  bool bag = false;
  std::int64_t date_ns = 0;  // of a calibration
  bool refused = false;
};

std::vector<FoundFile> filesIn(const std::string& folder) {
  std::vector<FoundFile> files;
  std::error_code error;
  const auto how = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator entry(folder, how, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string ending = entry->path().extension().string();
    if (!entry->is_regular_file() || (ending != ".bag" && ending != ".h5")) continue;
    files.push_back({entry->path().string(), fs::relative(entry->path(), folder).string(), ending == ".bag"});
  }
  if (error) throw InputError(folder + ": cannot be read: " + error.message());
  std::sort(files.begin(), files.end(),
            [](const FoundFile& a, const FoundFile& b) { return a.shown < b.shown; });
  if (files.empty())
    throw InputError(folder +
                     ": has no bag (.bag) and no calibration file (.h5), also not in its subfolders");
  return files;
}

// The calibration that the gain of a sheet refers to.
struct First {
  std::string file;
  std::int64_t date_ns = 0;
  Calibration calibration;
};

// Reads the files of a folder by sheet.
class Lives {
 public:
  explicit Lives(const fsr::settings::CommandLine& line) : how_(bagReadOptions(line)) {
    if (!line.has("first")) return;
    const std::string path = line.text("first", "");
    Calibration calibration = fsr::calibration::loadCalibration(path);
    const std::string sheet = check::sheetOf(calibration.sensor);
    firsts_[sheet] = First{path, std::numeric_limits<std::int64_t>::min(), std::move(calibration)};
  }

  void read(std::vector<FoundFile> files) {
    const ToolProgress progress = toolProgress();
    progress("looking for the first calibrations", 0);
    for (FoundFile& file : files) {
      if (!file.bag) trying(file, [&] { compareWithFirst(files, file); });
    }
    double done = 0;
    for (FoundFile& file : files) {
      progress("reading " + file.shown, done++ / static_cast<double>(files.size()));
      if (!file.refused) trying(file, [&] { add(file, stateOf(file)); });
    }
  }

  std::vector<check::SheetLife> lives(const check::LifeOptions& options) const {
    std::vector<check::SheetLife> lives;
    for (const auto& [sheet, states] : states_) {
      const auto first = firsts_.find(sheet);
      lives.push_back(check::lifeOf(states, first == firsts_.end() ? "" : first->second.file, options));
    }
    return lives;
  }

  const std::vector<fsr::report::SkippedFile>& skipped() const { return skipped_; }

 private:
  // What cannot be read is remembered, and the others are read all the same.
  template <typename Use>
  void trying(FoundFile& file, const Use& use) {
    try {
      use();
    } catch (const std::exception& error) {
      std::string reason = fsr::settings::sentenceOf(error).what();
      if (reason.rfind(file.path + ": ", 0) == 0) reason.erase(0, file.path.size() + 2);
      skipped_.push_back({file.shown, reason});
      file.refused = true;
    }
  }

  // Keeps the earliest calibration of each sheet.
  void compareWithFirst(const std::vector<FoundFile>& files, FoundFile& file) {
    Calibration calibration = fsr::calibration::loadCalibration(file.path);
    file.date_ns = dateOf(calibration, files);
    const std::string sheet = check::sheetOf(calibration.sensor);
    const auto known = firsts_.find(sheet);
    if (known == firsts_.end() || known->second.date_ns > file.date_ns)
      firsts_[sheet] = First{file.shown, file.date_ns, std::move(calibration)};
  }

  // When the first bag of the folder from which it was trained was recorded; where none is in the folder, the
  // date of the training.
  std::int64_t dateOf(const Calibration& calibration, const std::vector<FoundFile>& files) {
    std::optional<std::int64_t> first;
    for (const fsr::calibration::SourceBag& source : calibration.provenance.bags) {
      for (const FoundFile& file : files) {
        if (!file.bag || source.sha256.empty() || fs::path(file.path).filename() != source.name) continue;
        const auto& [sha256, start_ns] = identityOf(file.path);
        if (sha256 == source.sha256 && (!first || start_ns < *first)) first = start_ns;
      }
    }
    return first ? *first : check::dateOf(calibration.provenance.date);
  }

  // SHA-256 and start [ns] of a bag; empty where it cannot be read, which is named when its turn comes.
  const std::pair<std::string, std::int64_t>& identityOf(const std::string& path) {
    const auto [place, fresh] = identities_.try_emplace(path);
    if (!fresh) return place->second;
    try {
      const fsr::dataset::Recording recording = readBag(path, how_);
      place->second = {recording.sha256, recording.start_ns};
    } catch (const std::exception&) {
    }
    return place->second;
  }

  check::SheetState stateOf(const FoundFile& file) {
    const auto firstOf = [&](const fsr::dataset::SensorIdentity& sensor) {
      const auto found = firsts_.find(check::sheetOf(sensor));
      return found == firsts_.end() ? nullptr : &found->second.calibration;
    };
    if (!file.bag) {
      const Calibration calibration = fsr::calibration::loadCalibration(file.path);
      check::SheetState state = check::stateOf(calibration, firstOf(calibration.sensor));
      state.date_ns = file.date_ns;
      return state;
    }
    const fsr::dataset::Recording recording = readBag(file.path, how_);
    const auto [twin, fresh] = shown_.emplace(recording.sha256, file.shown);
    if (!fresh) throw InputError("it is a copy of " + twin->second + ", which is counted once");
    return check::stateOf(recording, firstOf(recording.sensor));
  }

  void add(const FoundFile& file, check::SheetState state) {
    state.file = file.shown;
    std::vector<check::SheetState>& states = states_[state.sheet];
    if (!states.empty() &&
        (!(states.front().layout.size == state.layout.size) || states.front().full_scale != state.full_scale))
      throw InputError("it has the serial number of " + states.front().file +
                       ", but another matrix or converter");
    states.push_back(std::move(state));
  }

  BagReadOptions how_;
  std::map<std::string, First> firsts_;                                     // by sheet
  std::map<std::string, std::vector<check::SheetState>> states_;            // by sheet
  std::map<std::string, std::pair<std::string, std::int64_t>> identities_;  // of bags, by path
  std::map<std::string, std::string> shown_;                                // of bags, by SHA-256
  std::vector<fsr::report::SkippedFile> skipped_;
};

fs::path livesFolder(const fsr::settings::CommandLine& line) {
  const fs::path folder = outputFolder(line.text("output", ""));
  line.requireWritable((folder / "life.csv").string(), fsr::settings::file_kind::kTable);
  line.requireWritable((folder / "life.json").string(), fsr::settings::file_kind::kJson);
  return folder;
}

// The life of each sheet in the folder of the command line. Returns 0, 1 if a file could not be used, 3 if
// only the figures are missing.
int showLives(const CommandLine& line, std::ostream& out) {
  if (line.files().size() != 1) throw InputError(line.files()[1] + ": give one folder");
  check::LifeOptions options;
  options.surface = line.text("surface", "");
  options.level = line.number("level", options.level, {1e-4, 0.2, ""});
  const std::vector<FoundFile> files = filesIn(line.files().front());
  fs::path folder;
  if (line.has("output")) folder = livesFolder(line);
  Lives reading(line);
  reading.read(files);
  const std::vector<fsr::report::SkippedFile>& skipped = reading.skipped();
  const std::vector<check::SheetLife> lives = reading.lives(options);
  if (lives.empty()) {
    throw InputError(line.files().front() + ": none of its files could be used: " + skipped.front().file +
                     ": " + skipped.front().reason);
  }
  for (const check::SheetLife& life : lives) out << fsr::report::lifeText(life) << '\n';
  for (const fsr::report::SkippedFile& file : skipped)
    out << "Not used: " << file.file << ": " << file.reason << '\n';
  int status = 0;
  if (!folder.empty()) {
    fsr::settings::replaceFile((folder / "life.csv").string(), fsr::report::lifeCsv(lives));
    fsr::settings::replaceFile((folder / "life.json").string(), fsr::report::lifeJson(lives, skipped));
    out << "Written to " << folder.string() << '\n';
    if (!line.has("no-figures")) status = figuresDrawn("life.py", {folder.string()}, std::cerr);
  }
  return skipped.empty() ? status : kSkipped;
}

CommandLine checkCalibrationOptions() {
  CommandLine line(
      "check_calibration",
      "CALIBRATION BAG... [--correct] [--output CHILD] [--report FILE], or DIR [--output DIR]",
      "Is a calibration still good? It compares maps with the chamber pressure of new bags, and how the "
      "sheet "
      "rests with the surface of each bag. With --correct it also asks whether gain and offset have changed: "
      "still good, corrected, recalibrate or cannot tell.\n"
      "Of a folder it reads the bags and calibration files, also in subfolders, and prints gain, zero, "
      "noise, "
      "dead and stuck taxels, held-out error and temperature of each sheet by date, and what changed "
      "suddenly. "
      "Sheets are told apart by their serial numbers. A calibration has the date of its bags where they are "
      "in "
      "the folder, else that of its training.\n"
      "Exit status: 0 whatever the verdict is; of a folder 1 if a file could not be used, which is then "
      "named, "
      "and 3 if only the figures could not be drawn; 2 if there is nothing to show.");
  line.flag("correct", "correct gain and offset from at least three cycles on surfaces of the training")
      .flag("same-mount",
            "with --correct: the sheet was not taken out since the training, so that no mount differs; "
            "otherwise one new mount cannot be told from wear")
      .output("output", "PATH",
              "with --correct: calibration file to write if it is corrected; of a folder: write life.csv, "
              "life.json and a figure of each sheet to this folder")
      .output("report", "FILE", "also write verdict and figures as JSON")
      .input("first", "FILE",
             "of a folder: calibration that the gain refers to; default: the earliest one of each sheet")
      .option("surface", "NAME",
              "of a folder: surface from which gain, zero and noise are taken; default: the one recorded on "
              "most dates")
      .option(
          "level", "P",
          "of a folder: probability that a date at which nothing changed shows a change by chance, 0.0001 "
          "to 0.2; default 0.01")
      .flag("no-figures", "of a folder, with --output: write the tables only");
  return addBagOptions(addUnitOption(line));
}

int checkOnBags(const CommandLine& line, std::ostream& out) {
  line.refuse({"first", "surface", "level", "no-figures"},
              "is for the life of a sheet, of a folder; remove it");
  fsr::check::CheckOptions options;
  options.correct = line.has("correct");
  options.same_mount = line.has("same-mount");
  if (!options.correct)
    line.refuse({"same-mount", "output"}, "is of --correct, which is not given; remove it");
  const fsr::report::CheckOutputs outputs{line.text("output", ""), line.text("report", "")};
  fsr::report::requireCheckOutputs(outputs);
  const std::string path = line.files().front();
  const std::vector<std::string> bags(line.files().begin() + 1, line.files().end());
  const fsr::calibration::Calibration calibration =
      fsr::calibration::loadCalibration(path, fsr::calibration::CalibrationParts::kWithoutStatistics);
  if (options.correct) fsr::check::requireTrained(calibration);
  out << "Calibration " << calibration.id << " (" << fsr::compensation::schemeName(calibration.tables.scheme)
      << ", " << calibration.provenance.date << ") on " << bags.size()
      << (bags.size() == 1 ? " bag\n" : " bags\n");
  for (const std::string& sentence : calibration.provenance.conditioning)
    out << "Trained with " << sentence << '\n';
  const fsr::check::CheckResult result =
      fsr::check::check(calibration, readBags(bagReadOptions(line), bags), options);
  out << fsr::report::checkText(result, calibration)
      << fsr::report::writeCheck(result, calibration.id, outputs) << std::flush;
  return 0;
}

}  // namespace

int checkCalibrationTool(int argc, const char* const* argv, std::ostream& out) {
  CommandLine line = checkCalibrationOptions();
  if (!line.parse(argc, argv, out)) return 0;
  takeUnit(line);
  if (line.files().empty()) {
    throw InputError(
        "no CALIBRATION and BAG is given, and no DIR for the life of a sheet; see check_calibration --help");
  }
  if (!std::filesystem::is_directory(line.files().front())) return checkOnBags(line, out);
  line.refuse({"correct", "same-mount", "report", "unit"},
              "is for a calibration and bags, not for a folder; remove it");
  return showLives(line, out);
}

std::optional<std::vector<std::string>> wordsOfCheck(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + std::min(1, argc), argv + argc);
  for (const std::string name : {"--check", "--correct"}) {
    const auto place = std::find_if(words.begin(), words.end(), [&](const std::string& word) {
      return word == name || word.rfind(name + "=", 0) == 0;
    });
    if (place == words.end()) continue;
    std::vector<std::string> file;  // the calibration comes first now
    if (*place != name) {
      file = {place->substr(name.size() + 1)};
    } else if (place + 1 != words.end()) {
      file = {*(place + 1)};
      words.erase(place + 1);
    }
    words.erase(place);
    words.insert(words.begin(), file.begin(), file.end());
    if (name == "--correct") words.push_back("--correct");
    return words;
  }
  return std::nullopt;
}

int checkInstead(const std::string& earlier, const std::vector<std::string>& words, std::ostream& out) {
  std::vector<const char*> arguments = {"check_calibration"};
  std::string now = earlier + " is now check_calibration:";
  for (const std::string& word : words) {
    now += ' ' + word;
    arguments.push_back(word.c_str());
  }
  if (words != std::vector<std::string>{"--help"}) out << now << '\n';  // man pages are made of the help
  return checkCalibrationTool(static_cast<int>(arguments.size()), arguments.data(), out);
}

int calibrationHistoryTool(int argc, const char* const* argv, std::ostream& out) {
  return checkInstead("calibration_history", {argv + 1, argv + argc}, out);
}

}  // namespace fsr_ros
