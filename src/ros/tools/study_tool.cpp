#include <filesystem>
#include <iostream>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/shard_file.h"
#include "report/study/study_report.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/tool_options.h"
#include "ros/tools/tools.h"
#include "settings/command_line.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "settings/sha256.h"
#include "simulation/session.h"
#include "simulation/settings_text.h"
#include "study/study.h"
#include "study/study_pieces.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;
using fsr::report::FoundShard;
using fsr::report::Shard;
using fsr::settings::InputError;
using fsr::study::StudyParts;

// A shard of a study: where it is written and what must be alike in all shards.
struct StudyShard {
  fsr::report::Shard shard;
  std::string folder;
  std::map<std::string, std::string> options;  // besides the plan and the recordings

  // The file that the shard writes last.
  std::string path() const { return fs::path(folder) / fsr::report::shardFileName(shard); }
};

constexpr char kTool[] = "study";

std::string piecesFileName(const Shard& shard) {
  return "pieces_" + std::to_string(shard.number) + "_of_" + std::to_string(shard.of) + ".json";
}

// The recordings in their order, which changes the numbers.
void addRecordings(const StudyParts& parts, std::map<std::string, std::string>& options) {
  std::size_t number = 0;
  for (const fsr::calibration::SourceBag& bag : parts.frame.provenance.bags) {
    options["recording " + std::to_string(++number)] =
        bag.sha256.empty() ? bag.name : bag.name + " (SHA-256 " + bag.sha256 + ")";
  }
}

// Throws unless the pieces are those that the shard has to compute.
void requireOwnPieces(const std::string& path, const Shard& shard, const StudyParts& parts) {
  std::size_t own = 0;
  for (std::size_t i = 0; i < parts.pieces_of_study; ++i) own += shard.has(i);
  for (const auto& [number, piece] : parts.computed)
    if (!shard.has(number) || number >= parts.pieces_of_study) own = parts.computed.size() + 1;
  if (own != parts.computed.size())
    throw InputError(path + ": does not have the pieces of shard " + std::to_string(shard.number) + " of " +
                     std::to_string(shard.of) + "; run this shard again");
}

// Writes the pieces, and then the file of the shard.
void writeStudyShard(const StudyShard& shard, const StudyParts& parts, std::ostream& out) {
  const std::string name = piecesFileName(shard.shard), content = fsr::report::studyPartsJson(parts);
  fsr::report::ShardFile file{kTool, {}, shard.shard, shard.options, {}};
  file.options.merge(fsr::report::studyOptions(parts.frame.plan));
  addRecordings(parts, file.options);
  file.files[name] = fsr::settings::sha256(content.data(), content.size());
  fsr::settings::replaceFile(fs::path(shard.folder) / name, content);
  fsr::settings::replaceFile(shard.path(), fsr::report::shardJson(file));
  out << parts.computed.size() << " of " << parts.pieces_of_study << " pieces of the study written to "
      << shard.path() << std::endl;
}

// All pieces of the study, from the files of all of its shards. Throws InputError if they do not belong
// together, with one sentence that names the file. The date is that of the first shard.
StudyParts readStudyShards(const std::vector<std::string>& paths) {
  StudyParts all;
  std::string first;
  for (const FoundShard& found : fsr::report::readShards(paths, kTool)) {
    const std::string path = fs::path(found.path).parent_path() / piecesFileName(found.file.shard);
    StudyParts parts = fsr::report::readStudyParts(path);
    requireOwnPieces(path, found.file.shard, parts);
    if (first.empty()) {
      first = path;
      all = std::move(parts);
    } else {
      fsr::report::addStudyParts(std::move(parts), path, first, all);
    }
  }
  return all;
}

fsr::settings::CommandLine studyOptions() {
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
  return addBagOptions(line);
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
  problem.recordings = readBags(bagReadOptions(line), line.files(), progress);
  return problem;
}

void write(const fs::path& folder, const fsr::study::StudyResult& result) {
  fsr::settings::replaceFile((folder / "results.json").string(), fsr::report::studyJson(result));
  fs::create_directories(folder / "tables");
  for (const auto& [name, content] : fsr::report::studyTables(result)) {
    fsr::settings::replaceFile((folder / "tables" / name).string(), content);
  }
}

fsr::study::StudyResult merged(const fsr::settings::CommandLine& line) {
  // What the shards have stored cannot be given again.
  line.refuse(
      {"shard", "simulation", "simulation-seed", "plan", "ambient", "namespace", "seed", "paper-only"},
      "cannot be used with --merge, which takes all settings from the shards");
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
  shard.folder = outputFolder(line.requiredText("output"));
  line.requireWritable(shard.path(), fsr::settings::file_kind::kJson);
  fs::remove(shard.path());  // a shard that is killed leaves none
  writeStudyShard(shard, computed(line, shard), out);
}

}  // namespace

int studyTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = studyOptions();
  if (!line.parse(argc, argv, out)) return 0;
  StudyShard shard;
  if (line.has("shard") && !line.has("merge")) {
    writeShard(line, shard, out);
    return 0;
  }
  const fs::path folder = outputFolder(line.requiredText("output"));
  line.requireWritable((folder / "results.json").string(), fsr::settings::file_kind::kJson);
  const fsr::study::StudyResult result =
      line.has("merge") ? merged(line) : fsr::study::joinParts(computed(line, shard));
  out << fsr::report::studyText(result);
  write(folder, result);
  out << "\nResults written to " << (folder / "results.json").string() << '\n';
  if (line.has("no-figures")) return 0;
  const int status = figuresDrawn("study.py", {folder.string()}, std::cerr);
  if (status == 0) out << "Report written to " << (folder / "report.html").string() << std::endl;
  return status;
}

}  // namespace fsr_ros
