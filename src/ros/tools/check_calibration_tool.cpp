#include "ros/tools/check_calibration_tool.h"

#include <algorithm>
#include <filesystem>

#include "check/check.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/check_report.h"
#include "ros/tools/sheet_lives.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"

namespace fsr_ros {

namespace {

using fsr::settings::CommandLine;
using fsr::settings::InputError;

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
      .flag("no-figures", "of a folder, with --output: write the tables only")
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several");
  return line;
}

void refuse(const CommandLine& line, const std::vector<std::string>& names, const std::string& why) {
  for (const std::string& name : names) {
    if (line.has(name)) throw InputError("--" + name + " " + why + "; remove it");
  }
}

int checkOnBags(const CommandLine& line, std::ostream& out) {
  refuse(line, {"first", "surface", "level", "no-figures"}, "is for the life of a sheet, of a folder");
  fsr::check::CheckOptions options;
  options.correct = line.has("correct");
  options.same_mount = line.has("same-mount");
  if (!options.correct) refuse(line, {"same-mount", "output"}, "is of --correct, which is not given");
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
  const fsr::check::CheckResult result = fsr::check::check(calibration, readBags(line, bags), options);
  out << fsr::report::checkText(result, calibration)
      << fsr::report::writeCheck(result, calibration.id, outputs) << std::flush;
  return 0;
}

}  // namespace

int checkCalibrationTool(int argc, const char* const* argv, std::ostream& out) {
  CommandLine line = checkCalibrationOptions();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  if (line.files().empty()) {
    throw InputError(
        "no CALIBRATION and BAG is given, and no DIR for the life of a sheet; see check_calibration --help");
  }
  if (!std::filesystem::is_directory(line.files().front())) return checkOnBags(line, out);
  refuse(line, {"correct", "same-mount", "report"}, "is for a calibration and bags, not for a folder");
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

}  // namespace fsr_ros
