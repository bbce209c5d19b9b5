#include "ros/tools/tools.h"

#include <algorithm>
#include <filesystem>

#include "calibration/merge.h"
#include "calibration/stages/deviation/budget_lines.h"
#include "dataset/conditioning.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/calibration_report.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_topics.h"
#include "ros/bags/training_options.h"
#include "ros/tools/map_gain.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "settings/text.h"

namespace fsr_ros {

namespace {

using fsr::calibration::HistoryFamily;

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
      .option(
          "zero", "NAME",
          "tare at rest at the start of a session: auto (expected unless sessions that were left out speak "
          "against it), none, session (expected in any case); default auto")
      .option(
          "temperature", "NAME",
          "factor for the temperature of the sheet, with a lag: auto (with a thermometer, where it wins on "
          "protocols and bags that were left out) or none; default auto, and none with --history none")
      .option("transducer", "PA",
              "standard uncertainty of the chamber's transducer, with its constant error, for the error "
              "budget [Pa]; default: not assessed")
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
  return addBagOptions(addUnitOption(line));
}

// Options of another model would have no effect.
void refuseOptionsOfOthers(const fsr::settings::CommandLine& line, const std::string& model) {
  const auto of = [&](const std::string& other) {
    return "is an option of --model " + other + ", but the model is " + model;
  };
  if (model != "grnn") line.refuse({"bandwidth", "spread", "distance", "equal-bins"}, of("grnn"));
  if (model != "forest") line.refuse({"trees", "minimum-leaf", "leaf-rule"}, of("forest"));
}

// The words of the tool by the names of the node's parameters.
struct TrainingWords {
  const fsr::settings::CommandLine& line;

  static std::string option(std::string name) {
    std::replace(name.begin(), name.end(), '_', '-');
    return name;
  }
  std::string text(const std::string& name, const std::string& fallback) const {
    return line.text(option(name), fallback);
  }
  std::string choice(const std::string& name, const std::vector<std::string>& choices,
                     const std::string& fallback) const {
    return line.choice(option(name), choices, fallback);
  }
  std::int64_t integer(const std::string& name, std::int64_t fallback,
                       const fsr::settings::Range& range) const {
    return line.integer(option(name), fallback, range);
  }
  bool flag(const std::string& name, bool fallback) const { return line.has(option(name)) || fallback; }
};

fsr::calibration::ZeroChoice zeroChoice(const fsr::settings::CommandLine& line) {
  const std::string zero = line.choice("zero", {"auto", "none", "session"}, "auto");
  if (zero == "auto") return fsr::calibration::ZeroChoice::kAuto;
  return zero == "none" ? fsr::calibration::ZeroChoice::kNone : fsr::calibration::ZeroChoice::kSession;
}

// What `--history` asks for: "auto", the name of a family, or the path of a verdict.yaml. The effects that it
// names propose a family, which is tried before the others; held-out error still decides.
fsr::calibration::HistoryChoice historyChoice(const std::string& text, std::ostream& out) {
  if (text == "auto") return {};
  if (!std::filesystem::exists(text)) {
    try {
      return {false, fsr::calibration::historyFromName(text)};
    } catch (const fsr::settings::InputError&) {
      throw fsr::settings::InputError(
          "--history is \"" + text +
          "\", but must be auto, none, plays, memories, both, or the path of a verdict.yaml");
    }
  }
  const fsr::report::VerdictFile verdict = fsr::report::readVerdict(text);
  const HistoryFamily family = historyFamilyOf(verdict.effects);
  if (family == HistoryFamily::kNone) {
    out << text << " names "
        << (verdict.effects.empty() ? "no effect" : fsr::settings::joined(verdict.effects))
        << ", which no model of memory describes; the history is chosen as with auto.\n";
  }
  return {true, family};
}

fsr::calibration::CalibrationOptions calibrationOptions(const fsr::settings::CommandLine& line,
                                                        std::ostream& out) {
  fsr::calibration::CalibrationOptions options = trainingOptions(TrainingWords{line});
  refuseOptionsOfOthers(line, options.regressor.name);
  options.scores = !line.has("no-scores");
  options.zero = zeroChoice(line);
  options.history = historyChoice(line.text("history", "auto"), out);
  const bool memory = options.history.automatic || options.history.family != HistoryFamily::kNone;
  options.temperature = line.choice("temperature", {"auto", "none"}, memory ? "auto" : "none") == "auto";
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

// Before hours of training. Empty = not wanted.
void requireOutputs(const std::string& calibration, const std::string& report) {
  namespace kind = fsr::settings::file_kind;
  if (!calibration.empty()) fsr::settings::requireReplaceable(calibration, kind::kCalibration);
  if (!report.empty()) fsr::settings::requireReplaceable(report, kind::kJson);
}

fsr::calibration::Calibration merge(const fsr::settings::CommandLine& line, std::ostream& out) {
  line.refuse({"scheme", "history", "zero", "temperature", "model", "bandwidth", "spread", "distance",
               "equal-bins", "trees", "minimum-leaf", "leaf-rule", "folds", "seed", "ambient", "namespace"},
              "cannot be used with --merge, because the files determine it");
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
  const fsr::calibration::CalibrationProblem problem{readBags(bagReadOptions(line), line.files()), chosen};
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
  if (!line.parse(argc, argv, out)) return 0;
  takeUnit(line);
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
