#include "ros/tools/calibration_history_tool.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "life/sheet_life.h"
#include "report/life/life_report.h"
#include "ros/bags/bag_walk.h"
#include "ros/bags/sensor_topics.h"
#include "ros/tools/figure_script.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"
#include "settings/file_kind.h"
#include "settings/foreign_error.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;
namespace life = fsr::life;
using fsr::calibration::Calibration;
using fsr::settings::InputError;

constexpr int kSkipped = 1;  // exit status if a file could not be used
fsr::settings::CommandLine calibrationHistoryOptions() {
  fsr::settings::CommandLine line(
      "calibration_history", "DIR [--output DIR]",
      "Shows how each sheet changed from date to date. It reads the bags and calibration files in a folder "
      "and "
      "its subfolders, and prints gain, zero, noise, dead and stuck taxels, held-out error and temperature "
      "by "
      "date, and what changed suddenly. Sheets are told apart by their serial numbers. A calibration has the "
      "date of its bags where they are in the folder, else that of its training.\n"
      "Exit status: 0 whatever changed; 1 if a file could not be used, which is then named; 2 if there is "
      "nothing to show; 3 if only the figures could not be drawn.");
  line.output("output", "DIR", "also write life.csv, life.json and a figure of each sheet to this folder")
      .input("first", "FILE",
             "calibration that the gain refers to; default: the earliest one of each sheet in the folder")
      .option("surface", "NAME",
              "surface from which gain, zero and noise are taken; default: the one recorded on most dates")
      .option("level", "P",
              "probability that a date at which nothing changed shows a change by chance, 0.0001 to 0.2; "
              "default 0.01")
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several")
      .flag("no-figures", "with --output: write the tables only");
  return line;
}

// A bag or calibration file below the folder.
struct FoundFile {
  std::string path;
  std::string shown;  // relative to the folder
  bool bag = false;
};

std::vector<FoundFile> filesIn(const std::string& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder + ": there is no such folder");
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
  if (files.empty()) {
    throw InputError(folder +
                     ": has no bag (.bag) and no calibration file (.h5), also not in its subfolders");
  }
  return files;
}

// The bytes of a bag, and when it was recorded.
struct BagBytes {
  std::string sha256;
  std::int64_t begin_ns = std::numeric_limits<std::int64_t>::max();
};

BagBytes bytesOf(const std::string& path) {
  BagBytes bytes;
  tellingOfDamage(path, [&] {
    bytes.sha256 = BagWalk(path).run([&](std::uint32_t, MessageBytes message) {
      bytes.begin_ns = std::min(bytes.begin_ns, 1'000'000'000 * static_cast<std::int64_t>(message.seconds) +
                                                    static_cast<std::int64_t>(message.nanoseconds));
    });
  });
  return bytes;
}

// Finds the bags of the folder from which a calibration was trained. Only bags with the name of such a one
// are read for it.
class SourceDates {
 public:
  explicit SourceDates(const std::vector<FoundFile>& files) {
    for (const FoundFile& file : files) {
      if (file.bag) by_name_[fs::path(file.path).filename().string()].push_back(file.path);
    }
  }

  // When the first of them was recorded; where none is in the folder, the date of the training.
  std::int64_t dateOf(const Calibration& calibration) {
    std::int64_t first = std::numeric_limits<std::int64_t>::max();
    for (const fsr::calibration::SourceBag& source : calibration.provenance.bags) {
      for (const std::string& path : by_name_[source.name]) {
        if (!source.sha256.empty() && known(path).sha256 == source.sha256)
          first = std::min(first, known(path).begin_ns);
      }
    }
    const bool found = first != std::numeric_limits<std::int64_t>::max();
    return found ? first : life::dateOf(calibration.provenance.date);
  }

 private:
  const BagBytes& known(const std::string& path) {
    const auto [place, fresh] = bytes_.try_emplace(path);
    if (fresh) {
      try {
        place->second = bytesOf(path);
      } catch (const std::exception&) {
        // Named when the bag itself is read.
      }
    }
    return place->second;
  }

  std::map<std::string, std::vector<std::string>> by_name_;
  std::map<std::string, BagBytes> bytes_;  // by path
};

// The calibration that the gain of a sheet refers to.
struct First {
  std::string file;
  std::int64_t date_ns = 0;
  Calibration calibration;
};

class History {
 public:
  explicit History(const fsr::settings::CommandLine& line) : line_(line) {
    if (!line.has("first")) return;
    const std::string path = line.text("first", "");
    Calibration calibration = fsr::calibration::loadCalibration(path);
    const std::string sheet = life::sheetOf(calibration.sensor);
    firsts_[sheet] = First{path, 0, std::move(calibration)};
    chosen_ = sheet;
  }

  void read(const std::vector<FoundFile>& files) {
    const ToolProgress progress = toolProgress();
    progress("looking for the first calibrations", 0);
    findFirsts(files);
    double done = 0;
    for (const FoundFile& file : files) {
      progress("reading " + file.shown, done++ / static_cast<double>(files.size()));
      if (refused_.count(file.path) == 0) trying(file, [&] { add(file, stateOf(file)); });
    }
  }

  std::vector<life::SheetLife> lives() const {
    life::LifeOptions options;
    options.surface = line_.text("surface", "");
    options.level = line_.number("level", options.level, {1e-4, 0.2, ""});
    std::vector<life::SheetLife> lives;
    for (const auto& [sheet, states] : states_) {
      const auto first = firsts_.find(sheet);
      lives.push_back(life::lifeOf(states, first == firsts_.end() ? "" : first->second.file, options));
    }
    return lives;
  }

  const std::vector<fsr::report::SkippedFile>& skipped() const { return skipped_; }

 private:
  // What cannot be read is remembered, and the others are read all the same.
  template <typename Use>
  void trying(const FoundFile& file, const Use& use) {
    try {
      use();
    } catch (const std::exception& error) {
      std::string reason = fsr::settings::sentenceOf(error).what();
      if (reason.rfind(file.path + ": ", 0) == 0) reason.erase(0, file.path.size() + 2);
      skipped_.push_back({file.shown, reason});
      refused_[file.path] = true;
    }
  }

  // The earliest calibration of each sheet.
  void findFirsts(const std::vector<FoundFile>& files) {
    SourceDates sources(files);
    for (const FoundFile& file : files) {
      if (file.bag) continue;
      trying(file, [&] {
        Calibration calibration = fsr::calibration::loadCalibration(file.path);
        const std::string sheet = life::sheetOf(calibration.sensor);
        const std::int64_t date = dates_[file.path] = sources.dateOf(calibration);
        const auto known = firsts_.find(sheet);
        if (sheet == chosen_ || (known != firsts_.end() && known->second.date_ns <= date)) return;
        firsts_[sheet] = First{file.shown, date, std::move(calibration)};
      });
    }
  }

  const Calibration* firstOf(const std::string& sheet) const {
    const auto found = firsts_.find(sheet);
    return found == firsts_.end() ? nullptr : &found->second.calibration;
  }

  life::SheetState stateOf(const FoundFile& file) {
    if (!file.bag) {
      const Calibration calibration = fsr::calibration::loadCalibration(file.path);
      life::SheetState state = life::stateOf(calibration, firstOf(life::sheetOf(calibration.sensor)));
      state.date_ns = dates_.at(file.path);
      return state;
    }
    const fsr::dataset::Recording recording = readBag(file.path, bagReadOptions(line_));
    const auto [twin, fresh] = hashes_.emplace(recording.sha256, file.shown);
    if (!fresh) throw InputError("it is a copy of " + twin->second + ", which is counted once");
    return life::stateOf(recording, firstOf(life::sheetOf(recording.sensor)));
  }

  void add(const FoundFile& file, life::SheetState state) {
    state.file = file.shown;
    std::vector<life::SheetState>& states = states_[state.sheet];
    if (!states.empty() &&
        (!(states.front().layout.size == state.layout.size) || states.front().full_scale != state.full_scale))
      throw InputError("it has the serial number of " + states.front().file +
                       ", but another matrix or converter");
    states.push_back(std::move(state));
  }

  const fsr::settings::CommandLine& line_;
  std::optional<std::string> chosen_;                            // sheet of --first
  std::map<std::string, First> firsts_;                          // by sheet
  std::map<std::string, std::vector<life::SheetState>> states_;  // by sheet
  std::map<std::string, std::int64_t> dates_;                    // of each calibration, by path [ns]
  std::map<std::string, std::string> hashes_;                    // of each bag: its name
  std::map<std::string, bool> refused_;                          // by path
  std::vector<fsr::report::SkippedFile> skipped_;
};

fs::path historyFolder(const fsr::settings::CommandLine& line) {
  const fs::path folder = outputFolder(line.text("output", ""));
  line.requireWritable((folder / "life.csv").string(), fsr::settings::file_kind::kTable);
  line.requireWritable((folder / "life.json").string(), fsr::settings::file_kind::kJson);
  return folder;
}

// Returns false if the figures are missing.
bool write(const fs::path& folder, const History& history, const std::vector<life::SheetLife>& lives,
           bool figures, std::ostream& out) {
  fsr::settings::replaceFile((folder / "life.csv").string(), fsr::report::lifeCsv(lives));
  fsr::settings::replaceFile((folder / "life.json").string(),
                             fsr::report::lifeJson(lives, history.skipped()));
  out << "Written to " << folder.string() << '\n';
  if (!figures) return true;
  try {
    drawFigures("life.py", {folder.string()});
  } catch (const InputError& error) {
    std::cerr << "calibration_history: the figures are missing: " << error.what() << std::endl;
    return false;
  }
  return true;
}

}  // namespace

int calibrationHistoryTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = calibrationHistoryOptions();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  if (line.files().size() != 1) {
    throw InputError(line.files().empty() ? "no DIR is given; see calibration_history --help"
                                          : line.files()[1] + ": give one folder");
  }
  line.number("level", 0.01, {1e-4, 0.2, ""});  // before the bags are read
  const std::vector<FoundFile> files = filesIn(line.files().front());
  std::optional<fs::path> folder;
  if (line.has("output")) folder = historyFolder(line);
  History history(line);
  history.read(files);
  const std::vector<life::SheetLife> lives = history.lives();
  if (lives.empty()) {
    const fsr::report::SkippedFile& skipped = history.skipped().front();
    throw InputError(line.files().front() + ": none of its files could be used: " + skipped.file + ": " +
                     skipped.reason);
  }
  for (const life::SheetLife& life : lives) out << fsr::report::lifeText(life) << '\n';
  for (const fsr::report::SkippedFile& skipped : history.skipped())
    out << "Not used: " << skipped.file << ": " << skipped.reason << '\n';
  const bool drawn = !folder || write(*folder, history, lives, !line.has("no-figures"), out);
  if (!history.skipped().empty()) return kSkipped;
  return drawn ? 0 : kFiguresMissing;
}

}  // namespace fsr_ros
