#include "fsr_pressure_map/ros/train_tool.h"

#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/report/calibration_report.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/command_line.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/replace_file.h"

namespace fsr_ros {

namespace {

fsr::CommandLine options() {
  fsr::CommandLine line("train", "BAG... --output FILE",
                        "Trains a calibration from bags of a matrix in a pressure chamber: topics raw, "
                        "chamber_pressure and curvature, and matrix_info and temperature where recorded.");
  line.option("output", "FILE", "calibration file to write (HDF5)")
      .option("scheme", "NAME", fsr::schemeList() + "; default per_curvature")
      .option("ambient", "PA", "ambient pressure [Pa]; default: what matrix_info says, else 101325")
      .option("namespace", "NS", "the sensor's namespace, where a bag holds several")
      .option("bandwidth", "SIGMA", "spread of the GRNN in deviations of the readings; default 2^-7")
      .option("folds", "N", "sections of the cross-validation, 2 to 20; default 5")
      .option("seed", "N", "kept in the file; default 1")
      .option("threads", "N", "default: one for each core; the numbers do not depend on it")
      .flag("no-scores", "leave the cross-validated scores out")
      .option("report", "FILE", "also write coverage, scores and provenance as JSON");
  return line;
}

fsr::CalibrationOptions calibrationOptions(const fsr::CommandLine& line) {
  fsr::CalibrationOptions options;
  options.scheme = fsr::schemeFromName(line.text("scheme", fsr::schemeName(options.scheme)));
  options.bandwidth = line.number("bandwidth", options.bandwidth, {1e-6, 1e3, ""});
  options.folds = static_cast<std::size_t>(line.integer("folds", 5, {2, 20, ""}));
  options.seed = static_cast<std::uint64_t>(line.integer("seed", 1, {0, 1e15, ""}));
  options.threads = static_cast<unsigned>(line.integer("threads", 0, {0, 1024, ""}));
  options.scores = !line.has("no-scores");
  return options;
}

std::vector<fsr::Recording> readBags(const fsr::CommandLine& line) {
  BagReadOptions options;
  options.topics = line.text("namespace", "");
  if (line.has("ambient")) options.recording.ambient_pressure = line.number("ambient", 0, {0, 120e3, "Pa"});
  std::vector<fsr::Recording> recordings;
  for (const std::string& path : line.files()) recordings.push_back(readBag(path, options));
  return recordings;
}

std::string fullPath(const std::string& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

void showProgress(std::size_t done, std::size_t taxels) {
  std::cerr << "\rtaxel " << done << " of " << taxels << (done == taxels ? "\n" : "") << std::flush;
}

}  // namespace

int trainTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::CommandLine line = options();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  const std::string output = line.requiredText("output");
  const std::string report = line.text("report", "");
  const fsr::CalibrationOptions chosen = calibrationOptions(line);
  fsr::requireReplaceable(output);
  if (!report.empty()) fsr::requireReplaceable(report);

  const fsr::CalibrationProblem problem{readBags(line), chosen};
  fsr::validate(problem);
  out << fsr::coverageText(fsr::coverageOf(problem.recordings, chosen.folds)) << std::endl;
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  fsr::Calibration calibration =
      fsr::calibrate(problem, terminal ? showProgress : fsr::CalibrationProgress{});
  out << fsr::warningsText(calibration) << fsr::scoresText(calibration.scores) << std::endl;
  calibration.id = fsr::saveCalibration(calibration, output);
  if (!report.empty()) fsr::replaceFile(report, fsr::calibrationJson(calibration));
  out << "Calibration " << calibration.id << " (" << fsr::schemeName(chosen.scheme) << ") is in "
      << fullPath(output) << std::endl;
  if (!report.empty()) out << "Report is in " << fullPath(report) << std::endl;
  return 0;
}

}  // namespace fsr_ros
