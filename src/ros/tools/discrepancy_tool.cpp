#include "ros/tools/tools.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "dataset/protocols.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/discrepancy_report.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_topics.h"
#include "ros/bags/bag_walk.h"
#include "ros/bags/resource_path.h"
#include "ros/tools/discrepancy_files.h"
#include "ros/tools/map_gain.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"
#include "settings/replace_file.h"
#include "simulation/rig.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr char kDefaultSimulation[] = "package://fsr_pressure_map/config/simulation/core.yaml";

fsr::settings::CommandLine discrepancyOptions() {
  fsr::settings::CommandLine line(
      "discrepancy", "[--simulation FILE] BAG... --output DIR  |  --confirm verdict.yaml NEWBAG...",
      "Finds where a simulation and measured bags disagree, which physical effect is missing and how small "
      "the gap is\nwith this effect. The verdict may also be that nothing is missing, or that no effect of "
      "the "
      "library explains the\ngap. A folder stands for the bags in it. The number of times that the hold-out "
      "cycles of a bag were "
      "used is kept in\nROS_HOME/fsr_pressure_map/show_opened.");
  line.input("simulation", "FILE",
             "simulation to start from (config/simulation/core.yaml, with the layout of the bags)")
      .output("output", "DIR", "folder for verdict.yaml, simulation.yaml, results.json and report.html")
      .option(
          "ask", "ID,...",
          "effects to ask about: each gets an answer; if nothing is found and the bags cannot show one of "
          "them, that is the verdict")
      .option("least-gap", "KPA",
              "rms at the map below which a discrepancy does not matter [kPa] (0.2 % of the range of the "
              "chamber's pressure)")
      .flag("repeat", "go on adding effects until no further effect is found")
      .input("confirm", "FILE", "a verdict.yaml: test its prediction on these new bags")
      .option("without", "ID,...", "leave these effects out of the library")
      .option("seed", "N", "seed of the split into fit and hold-out cycles, and of the tests (1)")
      .option("threads", "N", "number of threads, 0 = one for each core (0); the results do not depend on it")
      .flag("no-report", "do not write report.html and its figures");
  return addBagOptions(line);
}

std::vector<std::string> measuredBags(const fsr::settings::CommandLine& line) {
  const std::vector<std::string> bags = bagsIn(line.files());
  if (bags.empty()) throw fsr::settings::InputError("no BAG is given; see discrepancy --help");
  return bags;
}

// Without --simulation: the core simulation with the matrix of the bags.
fsr::simulation::SimulationSettings simulationFor(const fsr::settings::CommandLine& line,
                                                  const fsr::dataset::Recording& recording) {
  if (line.has("simulation")) return fsr::simulation::readSimulationFile(line.text("simulation", ""));
  return fsr::simulation::fitted(fsr::simulation::readSimulationFile(resolveResource(kDefaultSimulation)),
                                 recording);
}

fsr::discrepancy::DiscrepancyOptions discrepancyOptions(const fsr::settings::CommandLine& line) {
  fsr::discrepancy::DiscrepancyOptions chosen;
  chosen.ask = line.list("ask");
  chosen.leave_out = line.list("without");
  chosen.repeat = line.has("repeat");
  if (line.has("least-gap")) {
    constexpr double kKilopascal = 1e3;  // [Pa]
    chosen.least_gap = kKilopascal * line.number("least-gap", 0, {0, 1e4, "kPa"});
  }
  chosen.seed = static_cast<std::uint64_t>(line.integer("seed", 1, {0, 9e15, ""}));
  chosen.threads = threadsOf(line);
  return chosen;
}

void countUses(fsr::discrepancy::DiscrepancyReport& report) {
  const ShowLedger ledger;
  for (fsr::discrepancy::InputUse& input : report.inputs) {
    if (input.hold_out_opened > 0 && !input.sha256.empty())
      input.hold_out_opened = ledger.open(input.sha256, report.seed);
  }
}

int drawReport(const std::string& folder, std::ostream& out) {
  const int status = figuresDrawn("discrepancy.py", {folder}, out);
  if (status == 0) out << "Report: " << folder << "/report.html" << std::endl;
  return status;
}

// The command that recomputes the gap of the verdict in a folder. The files that are written may go to other
// people, so they hold names only: of the folder, and of the bags and folders as they were given.
std::string recomputeByNames(const std::string& folder, const fsr::settings::CommandLine& line) {
  const auto nameOf = [](const std::string& path) {
    return (fs::absolute(path) / ".").lexically_normal().parent_path().filename().string();
  };
  DrivingBags bags{{}, bagReadOptions(line)};
  for (const std::string& path : line.files()) bags.paths.push_back(nameOf(path));
  return recomputeCommand(nameOf(folder) + "/verdict.yaml", bags);
}

std::string gainForTheMap(const fsr::discrepancy::DiscrepancyProblem& problem,
                          const fsr::discrepancy::DiscrepancyReport& report) {
  std::vector<std::string> effects;
  for (const fsr::discrepancy::FoundEffect& effect : report.effects) effects.push_back(effect.id);
  return mapGain(problem.recordings, effects, problem.options.threads);
}

// A pressure that was recorded in a socket is not that on the sheet.
void requireChamber(const DrivingBags& bags) {
  for (const std::string& path : bags.paths) {
    if (sessionUse(path) != "socket") continue;
    throw fsr::settings::InputError(path + ": was recorded in a socket, where no chamber tells the pressure");
  }
}

int find(const fsr::settings::CommandLine& line, std::ostream& out) {
  const std::string folder = outputFolder(line.requiredText("output"));
  for (const auto& [file, kind] : discrepancyFiles()) line.requireWritable(folder + "/" + file, kind);
  const fsr::discrepancy::DiscrepancyProgress progress = toolProgress();
  fsr::discrepancy::DiscrepancyProblem problem;
  problem.options = discrepancyOptions(line);
  const DrivingBags bags{measuredBags(line), bagReadOptions(line)};
  problem.recordings = readBags(bags.how, bags.paths, progress);
  const bool changes = std::any_of(problem.recordings.begin(), problem.recordings.end(),
                                   [](const auto& recording) { return recording.losses.near_change > 0; });
  if (changes) problem.whole = readBags(bags.how, bags.paths, progress, true);
  problem.simulation = simulationFor(line, problem.recordings.front());
  fsr::discrepancy::DiscrepancyReport report = fsr::discrepancy::investigate(problem, progress);
  if (report.verdict == fsr::discrepancy::Verdict::kNone) requireChamber(bags);
  countUses(report);
  if (!report.hold_out.empty()) report.recompute = recomputeByNames(folder, line);
  report.map_gain = gainForTheMap(problem, report);
  writeDiscrepancy(report, folder, problem.recordings);
  const std::string verdict = (fs::path(line.requiredText("output")) / "verdict.yaml").string();
  if (!report.hold_out.empty())
    report.recompute = recomputeCommand(verdict, {line.files(), bagReadOptions(line)});
  out << fsr::report::discrepancyText(report) << "Written: " << folder << "/verdict.yaml" << std::endl;
  return line.has("no-report") ? 0 : drawReport(folder, out);
}

// A bag that was used to find the verdict cannot confirm it, nor can a copy that was compressed or written
// anew.
void requireNew(const std::vector<fsr::dataset::Recording>& recordings,
                const fsr::report::VerdictFile& verdict, const std::vector<std::string>& used_readings,
                const std::string& path) {
  for (const fsr::dataset::Recording& recording : recordings) {
    const auto isBag = [&](const fsr::discrepancy::InputUse& used) {
      return used.sha256 == recording.sha256;
    };
    const std::string readings = readingsSha256(recording);
    const bool used = std::any_of(verdict.inputs.begin(), verdict.inputs.end(), isBag);
    const bool copied = std::count(used_readings.begin(), used_readings.end(), readings) > 0;
    if (!used && !copied) continue;
    throw fsr::settings::InputError(recording.name + ": " + path + " was made from " +
                                    (used ? "this bag" : "a bag with the same readings") +
                                    "; only a bag recorded afterwards can confirm it");
  }
}

// Every confirmation is evidence, so none replaces another: confirmation.yaml, confirmation_2.yaml, ...
std::string newConfirmation(const std::string& folder) {
  std::string file = folder + "/confirmation.yaml";
  for (int number = 2; fs::exists(file); ++number)
    file = folder + "/confirmation_" + std::to_string(number) + ".yaml";
  return file;
}

int confirmVerdict(const fsr::settings::CommandLine& line, std::ostream& out) {
  const std::string path = line.text("confirm", "");
  const fsr::report::VerdictFile verdict = fsr::report::readVerdict(path);
  const StoredPrediction stored = readPredictionBeside(path);
  if (stored.frozen.prediction.effects.empty()) {
    throw fsr::settings::InputError(path + ": its verdict is " + verdict.verdict +
                                    ", which predicts nothing that can be confirmed");
  }
  const std::vector<fsr::dataset::Recording> recordings = readBags(bagReadOptions(line), measuredBags(line));
  requireNew(recordings, verdict, stored.frozen.readings_sha256, path);
  fsr::discrepancy::Confirmation answer =
      fsr::discrepancy::confirm(stored.frozen.prediction, stored.base, recordings);
  // What imitates the effect in the cycles of the verdict imitates it in such cycles again.
  if (fsr::dataset::havePaces(recordings, stored.frozen.paces))
    answer.sentence += " Same protocol: proves little.";
  std::vector<fsr::discrepancy::InputUse> inputs;
  for (const fsr::dataset::Recording& r : recordings) inputs.push_back({r.name, r.sha256, r.scans(), 0});
  const std::string folder =
      line.has("output") ? outputFolder(line.text("output", "")) : fs::absolute(path).parent_path().string();
  const std::string file = newConfirmation(folder);
  line.requireWritable(file);
  fsr::settings::replaceFile(file,
                             fsr::report::confirmationYaml(answer, stored.frozen.prediction.hash, inputs));
  out << fsr::report::confirmationText(answer) << "Written: " << file << std::endl;
  return 0;
}

// Removes the arguments __name:=... and __log:=... that roslaunch adds.
std::vector<const char*> withoutRemappings(int argc, const char* const* argv) {
  std::vector<const char*> words;
  for (int i = 0; i < argc; ++i) {
    if (std::string(argv[i]).find(":=") == std::string::npos) words.push_back(argv[i]);
  }
  return words;
}

}  // namespace

int discrepancyTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = discrepancyOptions();
  const std::vector<const char*> words = withoutRemappings(argc, argv);
  if (!line.parse(static_cast<int>(words.size()), words.data(), out)) return 0;
  const int status = line.has("confirm") ? confirmVerdict(line, out) : find(line, out);
  const bool launched = words.size() < static_cast<std::size_t>(argc);
  if (launched)
    out << "All is done. roslaunch now ends and calls this the death of a required process." << std::endl;
  return status;
}

}  // namespace fsr_ros
