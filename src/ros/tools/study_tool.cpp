#include "ros/tools/study_tool.h"

#include <filesystem>
#include <iostream>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/study/study_report.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/bag_options.h"
#include "ros/tools/figure_script.h"
#include "ros/tools/study_shards.h"
#include "ros/tools/tool_progress.h"
#include "settings/command_line.h"
#include "settings/file_kind.h"
#include "settings/replace_file.h"
#include "settings/sha256.h"
#include "simulation/session.h"
#include "simulation/settings_text.h"
#include "study/study.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr int kFiguresMissing = 3;  // exit status if only the figures could not be drawn

fsr::settings::CommandLine options() {
  fsr::settings::CommandLine line(
      "study", "BAG... --output DIR  |  --simulation FILE --output DIR  |  --merge [SHARD...] --output DIR",
      "Repeats the study of Ahmadizadeh and Menon (Sensors 2019, 19(24), 5519, doi:10.3390/s19245519) on "
      "bags of a "
      "matrix in a pressure chamber, or on a simulated one: regression algorithms, flat against bent "
      "surfaces, "
      "compensation methods, statistical tests, and how far the results hold for other data.");
  line.output("output", "DIR", "folder to write to; it is created if it does not exist")
      .input("simulation", "FILE", "simulate these recordings, e.g. config/simulation/paper.yaml")
      .option("simulation-seed", "N", "seed instead of the simulation's: another sheet and other noise")
      .input("plan", "FILE", "settings of the study, e.g. config/study/paper.yaml, which has the defaults")
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several")
      .option("seed", "N", "seed of down-sampling, forest and bootstrap; default: the plan's")
      .option("threads", "N",
              "number of threads; default: one for each core; the results do not depend on it")
      .flag("paper-only", "leave out what is not in the paper: harder splits, further schemes")
      .flag("no-figures", "write results.json and the tables only")
      .option("shard", "I/N",
              "compute only every Nth piece of the study, from the Ith on, and write it to --output; see "
              "docs/many_machines.md")
      .flag("merge",
            "write the results from the files of all shards (shard_I_of_N.json), default: those in --output");
  return line;
}

unsigned threadsOf(const fsr::settings::CommandLine& line) {
  return static_cast<unsigned>(line.integer("threads", 0, {0, 1024, ""}));
}

fsr::study::StudyPlan planOf(const fsr::settings::CommandLine& line) {
  fsr::study::StudyPlan plan =
      line.has("plan") ? fsr::study::readStudyPlanFile(line.text("plan", "")) : fsr::study::StudyPlan{};
  plan.seed =
      static_cast<std::uint64_t>(line.integer("seed", static_cast<std::int64_t>(plan.seed), {0, 1e15, ""}));
  plan.beyond_the_paper = plan.beyond_the_paper && !line.has("paper-only");
  plan.threads = threadsOf(line);
  return plan;
}

// Also tells the shards which rig it is.
void simulate(const fsr::settings::CommandLine& line, fsr::study::StudyProblem& problem, StudyShard& shard) {
  fsr::simulation::SimulationSettings settings =
      fsr::simulation::readSimulationFile(line.text("simulation", ""));
  settings.seed = static_cast<std::uint64_t>(
      line.integer("simulation-seed", static_cast<std::int64_t>(settings.seed), {0, 9e15, ""}));
  const std::string rig = simulationText(settings);
  shard.options["the SHA-256 of the simulation"] = fsr::settings::sha256(rig.data(), rig.size());
  problem.simulation = settings.name;
  problem.recordings = fsr::simulation::simulateSession(settings);
}

fsr::study::StudyProblem problemOf(const fsr::settings::CommandLine& line, const ToolProgress& progress,
                                   StudyShard& shard) {
  if (line.has("simulation") == !line.files().empty()) {
    throw fsr::settings::InputError("study: give either bags or --simulation FILE");
  }
  fsr::study::StudyProblem problem;
  problem.plan = planOf(line);
  if (line.has("simulation")) {
    simulate(line, problem, shard);
    return problem;
  }
  for (const char* const option : {"ambient", "namespace"})
    shard.options["--" + std::string(option)] = line.text(option, "not given");
  BagReadOptions reading = bagReadOptions(line);
  for (const std::string& path : line.files()) {
    reading.progress = told("reading " + path, progress);
    problem.recordings.push_back(readBag(path, reading));
  }
  return problem;
}

fs::path folderOf(const fsr::settings::CommandLine& line) {
  const fs::path folder = fs::absolute(line.requiredText("output")).lexically_normal();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw fsr::settings::InputError(folder.string() + ": the folder cannot be created (" + error.message() +
                                    "); give another one with --output");
  }
  return folder;
}

void write(const fs::path& folder, const fsr::study::StudyResult& result) {
  fsr::settings::replaceFile((folder / "results.json").string(), fsr::report::studyJson(result));
  fs::create_directories(folder / "tables");
  for (const auto& [name, content] : fsr::report::studyTables(result)) {
    fsr::settings::replaceFile((folder / "tables" / name).string(), content);
  }
}

// What the shards have stored cannot be given again.
void refuseWithMerge(const fsr::settings::CommandLine& line) {
  for (const char* const option :
       {"shard", "simulation", "simulation-seed", "plan", "ambient", "namespace", "seed", "paper-only"}) {
    if (!line.has(option)) continue;
    throw fsr::settings::InputError("--" + std::string(option) +
                                    " cannot be used with --merge, which takes all settings from the shards");
  }
}

fsr::study::StudyResult merged(const fsr::settings::CommandLine& line) {
  refuseWithMerge(line);
  const std::string folder = line.requiredText("output");
  fsr::study::StudyParts parts =
      readStudyShards(line.files().empty() ? fsr::report::shardsIn(folder) : line.files());
  parts.frame.plan.threads = threadsOf(line);
  return fsr::study::joinParts(parts);
}

// Reads or simulates the recordings and computes what `shard` has to.
fsr::study::StudyParts computed(const fsr::settings::CommandLine& line, StudyShard& shard) {
  const ToolProgress progress = toolProgress();
  const fsr::study::StudyProblem problem = problemOf(line, progress, shard);
  return fsr::study::computeParts(
      problem, [&](std::size_t piece) { return shard.shard.has(piece); },
      [&](const std::string& stage, std::size_t done, std::size_t total) {
        progress(stage, total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1);
      });
}

void writeShard(const fsr::settings::CommandLine& line, StudyShard& shard, std::ostream& out) {
  shard.shard = fsr::report::readShard(line.text("shard", ""));
  shard.folder = folderOf(line);
  line.requireWritable(shard.path(), fsr::settings::file_kind::kJson);
  fs::remove(shard.path());  // a shard that is killed leaves none
  writeStudyShard(shard, computed(line, shard), out);
}

}  // namespace

int studyTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = options();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  StudyShard shard;
  if (line.has("shard") && !line.has("merge")) {
    writeShard(line, shard, out);
    return 0;
  }
  const fs::path folder = folderOf(line);
  line.requireWritable((folder / "results.json").string(), fsr::settings::file_kind::kJson);
  const fsr::study::StudyResult result =
      line.has("merge") ? merged(line) : fsr::study::joinParts(computed(line, shard));
  out << fsr::report::studyText(result);
  write(folder, result);
  out << "\nResults written to " << (folder / "results.json").string() << '\n';
  if (line.has("no-figures")) return 0;
  try {
    drawFigures("study.py", {folder.string()});
  } catch (const fsr::settings::InputError& error) {
    std::cerr << "study: the figures are missing: " << error.what() << std::endl;
    return kFiguresMissing;
  }
  out << "Report written to " << (folder / "report.html").string() << std::endl;
  return 0;
}

}  // namespace fsr_ros
