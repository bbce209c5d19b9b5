#include "ros/tools/export_tool.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

#include "exports/animated_png.h"
#include "exports/csv_table.h"
#include "exports/picture_folder.h"
#include "exports/tekscan_file.h"
#include "exports/video_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_archive.h"
#include "ros/bags/scan_source.h"
#include "ros/tools/picture_options.h"
#include "settings/command_line.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

fsr::settings::CommandLine options() {
  fsr::settings::CommandLine line(
      "export", "BAG... --to FORMAT --output PATH, or ARCHIVE --to bag --output BAG",
      "Writes a recording in a format that needs no ROS. FORMAT is\n"
      "  csv      tidy table, one row for each taxel and scan (.gz: compressed); several bags in one file\n"
      "  tekscan  ASCII file as Tekscan's I-Scan and F-Scan save it (*.asf)\n"
      "  hdf5     archive of every topic\n"
      "  bag      restores the bag from such an archive, message by message, byte for byte\n"
      "  png      one picture for each map, in a new folder\n"
      "  movie    NAME.png (animated, needs no other program), or .mp4 .webm .mkv .avi .gif with ffmpeg\n"
      "docs/exports.md describes every column and dataset.");
  line.option("to", "FORMAT", "format to write")
      .option("output", "PATH", "file to write; an existing file is replaced")
      .option("calibration", "FILE", "compute the maps with this calibration instead of using recorded ones")
      .option("from", "S", "start, in seconds since the first scan (0)")
      .option("until", "S", "end, in seconds since the first scan (all)")
      .option("topics", "A,B", "hdf5: only these topics, full names or names under the namespace (all)")
      .option("rate", "HZ", "largest number of scans a second (all; pictures: 10)")
      .option("map", "TOPIC", "topic of the maps, if a bag holds several (pressure_map)")
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several");
  declarePictureOptions(line);
  return line;
}

ScanSelection selectionOf(const fsr::settings::CommandLine& line) {
  ScanSelection selection;
  selection.topics = line.text("namespace", "");
  selection.map = line.text("map", selection.map);
  selection.calibration = line.text("calibration", "");
  if (line.has("ambient")) selection.ambient = line.number("ambient", 0, {0, 120e3, "Pa"});
  selection.from = line.number("from", 0, {0, 1e9, "s"});
  selection.until = line.number("until", selection.until, {0, 1e9, "s"});
  selection.rate = line.number("rate", 0, {1e-3, 1e5, "Hz"});
  if (selection.from > selection.until) {
    throw fsr::settings::InputError("--from is " + line.text("from", "0") +
                                    ", but must not be later than --until, " + line.text("until", ""));
  }
  return selection;
}

void requireOne(const fsr::settings::CommandLine& line) {
  if (line.files().size() == 1) return;
  throw fsr::settings::InputError("give one file for --to " + line.text("to", "") +
                                  "; only csv takes several bags");
}

// Throws if an option was given that does not apply to this format.
void refuseOthers(const fsr::settings::CommandLine& line, const std::vector<std::string>& options) {
  for (const std::string& option : options) {
    if (!line.has(option)) continue;
    throw fsr::settings::InputError("--" + option + " cannot be used with --to " + line.text("to", ""));
  }
}

std::string outputOf(const fsr::settings::CommandLine& line) {
  const std::string output = line.requiredText("output");
  std::error_code error;
  for (const std::string& input : line.files()) {
    if (fs::equivalent(input, output, error)) {
      throw fsr::settings::InputError("--output is " + input + " itself; give another name");
    }
  }
  return output;
}

std::string fullPath(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

void sendAll(const fsr::settings::CommandLine& line, const ScanSelection& selection,
             fsr::exports::ScanSink& sink, std::ostream& out) {
  std::size_t scans = 0;
  for (const std::string& bag : line.files()) scans += sendScans(bag, selection, sink);
  if (scans == 0) {
    throw fsr::settings::InputError(line.files().front() +
                                    ": holds no scan between --from and --until; widen them");
  }
  sink.finish();
  out << scans << " scans written to " << fullPath(line.text("output", "")) << std::endl;
}

void writeCsv(const fsr::settings::CommandLine& line, std::ostream& out) {
  refuseOthers(line, {"topics"});
  refuseOthers(line, pictureOptionNames());
  const ScanSelection selection = selectionOf(line);
  fsr::exports::CsvTable table(outputOf(line));
  sendAll(line, selection, table, out);
}

void writeTekscan(const fsr::settings::CommandLine& line, std::ostream& out) {
  requireOne(line);
  refuseOthers(line, {"topics"});
  refuseOthers(line, pictureOptionNames());
  const ScanSelection selection = selectionOf(line);
  const std::string output = outputOf(line);
  if (fs::path(output).extension() == ".gz") {
    throw fsr::settings::InputError("--output is " + output + ", but only csv can be compressed");
  }
  fsr::exports::TekscanFile file(output);
  sendAll(line, selection, file, out);
}

ScanSelection picturesSelection(const fsr::settings::CommandLine& line,
                                const fsr::exports::PictureOptions& pictures) {
  requireOne(line);
  refuseOthers(line, {"topics"});
  ScanSelection selection = selectionOf(line);
  selection.rate = pictures.rate;
  selection.counts = false;
  return selection;
}

void writePictures(const fsr::settings::CommandLine& line, std::ostream& out) {
  const fsr::exports::PictureOptions pictures = pictureOptions(line);
  const ScanSelection selection = picturesSelection(line, pictures);
  fsr::exports::PictureFolder folder(outputOf(line), pictures);
  sendAll(line, selection, folder, out);
}

void writeMovie(const fsr::settings::CommandLine& line, std::ostream& out) {
  const fsr::exports::PictureOptions pictures = pictureOptions(line);
  const ScanSelection selection = picturesSelection(line, pictures);
  const std::string output = outputOf(line);
  const fs::path ending = fs::path(output).extension();
  std::unique_ptr<fsr::exports::ScanSink> movie;
  if (ending == ".png" || ending == ".apng") {
    movie = std::make_unique<fsr::exports::AnimatedPng>(output, pictures);
  } else {
    movie = std::make_unique<fsr::exports::VideoFile>(output, pictures);
  }
  sendAll(line, selection, *movie, out);
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream text(list);
  for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
  return parts;
}

void writeArchive(const fsr::settings::CommandLine& line, std::ostream& out) {
  requireOne(line);
  refuseOthers(line, {"calibration", "rate", "map", "ambient"});
  refuseOthers(line, pictureOptionNames());
  const ScanSelection range = selectionOf(line);
  const ArchiveSelection selection{range.topics, split(line.text("topics", "")), range.from, range.until};
  const ArchiveResult result = archiveBag(line.files().front(), selection, outputOf(line));
  if (!result.complaint.empty())
    out << "Warning: the group /scans is incomplete: " << result.complaint << "\n";
  out << result.messages << " messages written to " << fullPath(line.text("output", "")) << std::endl;
}

void writeBag(const fsr::settings::CommandLine& line, std::ostream& out) {
  requireOne(line);
  refuseOthers(line, {"calibration", "rate", "map", "ambient", "topics", "from", "until", "namespace"});
  refuseOthers(line, pictureOptionNames());
  const std::uint64_t messages = restoreBag(line.files().front(), outputOf(line));
  out << messages << " messages, identical to those of the bag, written to "
      << fullPath(line.text("output", "")) << std::endl;
}

using Writer = void (*)(const fsr::settings::CommandLine&, std::ostream&);

Writer writerOf(const std::string& format) {
  static const std::map<std::string, Writer> kWriters = {{"csv", writeCsv},      {"tekscan", writeTekscan},
                                                         {"hdf5", writeArchive}, {"bag", writeBag},
                                                         {"png", writePictures}, {"movie", writeMovie}};
  const auto found = kWriters.find(format);
  if (found != kWriters.end()) return found->second;
  std::string names;
  for (const auto& writer : kWriters) names += (names.empty() ? "" : ", ") + writer.first;
  throw fsr::settings::InputError("--to is \"" + format + "\", but must be one of " + names);
}

}  // namespace

int exportTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = options();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  const Writer write = writerOf(line.requiredText("to"));
  if (line.files().empty()) throw fsr::settings::InputError("give at least one BAG; see export --help");
  write(line, out);
  return 0;
}

}  // namespace fsr_ros
