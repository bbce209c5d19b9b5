#include "ros/tools/train_tool.h"

#include <filesystem>
#include <iostream>

#include "calibration/merge.h"
#include "calibration/stages/deviation/conditioning_line.h"
#include "dataset/conditioning.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "regression/regressors.h"
#include "report/budget_report.h"
#include "report/calibration_report.h"
#include "ros/bags/bag_topics.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/check_calibration_tool.h"
#include "ros/tools/history_option.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"
#include "settings/file_kind.h"
#include "settings/joined.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

fsr::settings::CommandLine trainOptions() {
  fsr::settings::CommandLine line(
      "train", "BAG... --output FILE, or --merge CALIBRATION... --output FILE, or --budget FILE",
      "Trains a calibration from bags of a matrix in a pressure chamber. It uses the topics raw, "
      "chamber_pressure and curvature, and matrix_info and temperature if they were recorded.");
  line.output("output", "FILE", "calibration file to write (HDF5)")
      .input("budget", "FILE", "print the error budget that this calibration holds, and do nothing else")
      .flag("merge",
            "merge calibration files: gives what training on all their bags would give, without scores")
      .option("scheme", "NAME",
              fsr::compensation::schemeList() + "; default " +
                  fsr::compensation::schemeName(fsr::calibration::CalibrationOptions{}.scheme))
      .option("model", "NAME", fsr::settings::joined(fsr::regression::regressorNames()) + "; default grnn")
      .option("history", "NAME",
              "model of the sheet's memory: auto (chosen on protocols that were left out), none, plays (a "
              "loop), memories (creep), both, or a verdict.yaml whose named effect is tried first; default "
              "auto")
      .option("zero", "NAME",
              "tare at rest at the start of a session: auto (expected if it wins on sessions that were left "
              "out), none, session (expected in any case); default auto")
      .option(
          "temperature", "NAME",
          "factor for the temperature of the sheet, with a lag: auto (with a thermometer, where it wins on "
          "protocols and bags that were left out) or none; default auto, and none with --history none")
      .option("transducer", "PA",
              "standard uncertainty of the chamber's transducer, with its constant error, for the error "
              "budget [Pa]; default: not assessed")
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several")
      .option(
          "bandwidth", "SIGMA",
          "bandwidth of the GRNN in standard deviations of the readings (paper: 0.0078125); default auto: "
          "chosen by nested cross-validation")
      .option("spread", "NAME",
              "how the bandwidth is understood, sigma or matlab (the spread of newgrnn); default sigma")
      .option("distance", "NAME",
              "distance in the GRNN's exponent, squared or literal (not squared, as the paper words it); "
              "default squared")
      .flag("equal-bins",
            "GRNN: give every bin of chamber pressure the same weight, however many scans it has")
      .option("trees", "N", "number of trees of the forest; default 150")
      .option("minimum-leaf", "N", "smallest number of readings in a leaf of the forest; default 5")
      .option("leaf-rule", "NAME",
              "a reading drawn twice counts twice in a leaf (draws, as in MATLAB) or once (distinct, as in "
              "scikit-learn); default draws")
      .option("folds", "N", "number of sections of the cross-validation, 2 to 20; default 5")
      .option("seed", "N", "seed of the forest's random draws, stored in the file; default 1")
      .option("threads", "N",
              "number of threads; default: one for each core; the results do not depend on it")
      .flag("no-scores", "do not compute the cross-validated scores")
      .flag("details", "print all tables of the training, not one screen; the file holds them in any case")
      .output("report", "FILE", "also write coverage, scores and provenance as JSON");
  return line;
}

// Throws if an option of another model is given, because it would have no effect.
void refuseOptionsOfOthers(const fsr::settings::CommandLine& line, const std::string& model) {
  const std::vector<std::pair<std::string, std::string>> options = {
      {"bandwidth", "grnn"}, {"spread", "grnn"},         {"distance", "grnn"},   {"equal-bins", "grnn"},
      {"trees", "forest"},   {"minimum-leaf", "forest"}, {"leaf-rule", "forest"}};
  for (const auto& [option, of] : options) {
    if (line.has(option) && of != model) {
      throw fsr::settings::InputError("--" + option + " is an option of --model " + of +
                                      ", but the model is " + model);
    }
  }
}

fsr::regression::RegressorOptions regressorOptions(const fsr::settings::CommandLine& line) {
  fsr::regression::RegressorOptions options;
  options.name = line.text("model", options.name);
  fsr::regression::makeRegressor(options);  // throws if there is no model of that name
  refuseOptionsOfOthers(line, options.name);
  options.grnn.spread =
      fsr::regression::spreadFromName(line.text("spread", fsr::regression::spreadName(options.grnn.spread)));
  options.grnn.distance = fsr::regression::distanceFromName(
      line.text("distance", fsr::regression::distanceName(options.grnn.distance)));
  if (line.has("equal-bins")) options.grnn.weighting = fsr::regression::SampleWeighting::kEachPressureBin;
  options.forest.trees = static_cast<std::size_t>(line.integer("trees", 150, {1, 1e5, ""}));
  options.forest.minimum_leaf = static_cast<std::size_t>(line.integer("minimum-leaf", 5, {1, 1e6, ""}));
  options.forest.leaf_count = fsr::regression::leafRuleFromName(
      line.text("leaf-rule", fsr::regression::leafRuleName(options.forest.leaf_count)));
  return options;
}

fsr::calibration::ZeroChoice zeroChoice(const std::string& text) {
  if (text == "auto") return fsr::calibration::ZeroChoice::kAuto;
  if (text == "none") return fsr::calibration::ZeroChoice::kNone;
  if (text == "session") return fsr::calibration::ZeroChoice::kSession;
  throw fsr::settings::InputError("--zero is \"" + text + "\", but must be auto, none or session");
}

fsr::calibration::CalibrationOptions calibrationOptions(const fsr::settings::CommandLine& line,
                                                        std::ostream& out) {
  fsr::calibration::CalibrationOptions options;
  options.scheme =
      fsr::compensation::schemeFromName(line.text("scheme", fsr::compensation::schemeName(options.scheme)));
  options.regressor = regressorOptions(line);
  const auto bandwidth = fsr::regression::bandwidthFromText(line.text("bandwidth", "auto"));
  options.choose_bandwidth = !bandwidth;
  if (bandwidth) options.regressor.grnn.bandwidth = *bandwidth;
  options.folds = static_cast<std::size_t>(line.integer("folds", 5, {2, 20, ""}));
  options.seed = static_cast<std::uint64_t>(line.integer("seed", 1, {0, 1e15, ""}));
  options.threads = threadsOf(line);
  options.scores = !line.has("no-scores");
  options.zero = zeroChoice(line.text("zero", "auto"));
  std::string remark;
  options.history = historyOption(line.text("history", "auto"), remark);
  if (!remark.empty()) out << remark << '\n';
  options.temperature = temperatureOption(line.text("temperature", ""), options.history);
  if (line.has("transducer")) options.reference_deviation = line.number("transducer", 0, {0, 1e7, "Pa"});
  return options;
}

int showBudget(const fsr::settings::CommandLine& line, std::ostream& out) {
  if (!line.files().empty() || line.has("output"))
    throw fsr::settings::InputError("--budget prints what the file holds; remove the bags and --output");
  const fsr::calibration::Calibration calibration = fsr::calibration::loadCalibration(
      line.text("budget", ""), fsr::calibration::CalibrationParts::kWithoutStatistics);
  out << "Calibration " << calibration.id << " (" << fsr::compensation::schemeName(calibration.tables.scheme)
      << ", " << calibration.provenance.date << ")\n"
      << fsr::report::budgetText(calibration.budget, calibration.layout);
  return 0;
}

// Throws if an option is given that `mode` takes from the files.
void refuseOptionsOfTraining(const fsr::settings::CommandLine& line, const std::string& mode) {
  for (const char* const option :
       {"scheme", "history", "zero", "temperature", "model", "bandwidth", "spread", "distance", "equal-bins",
        "trees", "minimum-leaf", "leaf-rule", "folds", "seed"}) {
    if (!line.has(option)) continue;
    throw fsr::settings::InputError("--" + std::string(option) + " cannot be used with --" + mode +
                                    ", because the files determine it");
  }
}

// Before hours of training. Empty = not wanted.
void requireOutputs(const std::string& calibration, const std::string& report) {
  namespace kind = fsr::settings::file_kind;
  if (!calibration.empty()) fsr::settings::requireReplaceable(calibration, kind::kCalibration);
  if (!report.empty()) fsr::settings::requireReplaceable(report, kind::kJson);
}

fsr::calibration::Calibration merge(const fsr::settings::CommandLine& line, std::ostream& out) {
  refuseOptionsOfTraining(line, "merge");
  for (const char* const option : {"ambient", "namespace"}) {
    if (!line.has(option)) continue;
    throw fsr::settings::InputError("--" + std::string(option) +
                                    " cannot be used with --merge, because the files determine it");
  }
  std::vector<fsr::calibration::MergePart> parts;
  for (const std::string& path : line.files()) {
    parts.push_back(
        {path, fsr::calibration::loadCalibration(path, fsr::calibration::CalibrationParts::kAll)});
  }
  fsr::calibration::MergeOptions options;
  options.threads = threadsOf(line);
  fsr::calibration::Calibration calibration = fsr::calibration::mergeCalibrations(parts, options);
  out << fsr::report::coverageText(calibration.coverage) << '\n' << fsr::report::warningsText(calibration);
  out << "A merged calibration has no scores, and the error of another mount is not part of its stated "
         "deviation;\ntrain on all the bags to get both.\n";
  return calibration;
}

fsr::calibration::Calibration train(const fsr::settings::CommandLine& line, std::ostream& out) {
  const fsr::calibration::CalibrationOptions chosen = calibrationOptions(line, out);
  const fsr::calibration::CalibrationProblem problem{readBags(line, line.files()), chosen};
  fsr::calibration::validate(problem);
  const bool details = line.has("details");
  if (details) {
    out << fsr::report::coverageText(fsr::dataset::coverageOf(problem.recordings, chosen.folds)) << std::endl;
  }
  fsr::calibration::Calibration calibration = fsr::calibration::calibrate(problem, toolProgress());
  // The events in the bags tell more than the recordings alone.
  const std::vector<fsr::dataset::Conditioning> conditioning =
      fsr::dataset::findConditioning(problem.recordings, conditioningSaid(line.files()));
  calibration.provenance.conditioning = fsr::dataset::conditioningSentences(conditioning);
  fsr::calibration::restateConditioning(conditioning, calibration.budget);
  out << (details
              ? fsr::report::trainingDetails(calibration)
              : fsr::report::trainingSummary(calibration) +
                    "All tables: --details; the file holds them, and train --budget prints its budget.\n");
  return calibration;
}

}  // namespace

int trainTool(int argc, const char* const* argv, std::ostream& out) {
  if (const auto words = wordsOfCheck(argc, argv)) return checkInstead("train --check", *words, out);
  fsr::settings::CommandLine line = trainOptions();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  if (line.has("budget")) return showBudget(line, out);
  const std::string output = line.requiredText("output");
  const std::string report = line.text("report", "");
  requireOutputs(output, report);

  fsr::calibration::Calibration calibration = line.has("merge") ? merge(line, out) : train(line, out);
  calibration.id = fsr::calibration::saveCalibration(calibration, output);
  if (!report.empty()) fsr::settings::replaceFile(report, fsr::report::calibrationJson(calibration));
  out << "Calibration " << calibration.id << " (" << fsr::compensation::schemeName(calibration.tables.scheme)
      << ", " << fsr::report::modelText(calibration) << ") written to " << fullPath(output) << std::endl;
  if (!report.empty()) out << "Report written to " << fullPath(report) << std::endl;
  if (!line.has("merge")) out << fsr::report::goodForText(calibration) << std::endl;
  return 0;
}

}  // namespace fsr_ros
