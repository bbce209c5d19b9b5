#include <filesystem>
#include <iostream>
#include <ostream>
#include <string>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/study/study_report.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/tool_options.h"
#include "ros/tools/tools.h"
#include "settings/command_line.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "simulation/session.h"
#include "study/study.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

fsr::settings::CommandLine studyOptions() {
  fsr::settings::CommandLine line(
      "study", "BAG... --output DIR  |  --simulation FILE --output DIR",
      "Repeats the study of Ahmadizadeh and Menon (Sensors 2019, 19(24), 5519, doi:10.3390/s19245519) on "
      "bags of a matrix in a pressure chamber, or on a simulated one: regression algorithms, flat against "
      "bent "
      "surfaces, compensation methods, statistical tests, and how far the results hold for other data.");
  line.output("output", "DIR", "folder to write to; it is created if it does not exist")
      .input("simulation", "FILE", "simulate these recordings, e.g. config/simulation/paper.yaml")
      .option("simulation-seed", "N", "seed instead of the simulation's: another sheet and other noise")
      .input("plan", "FILE", "settings of the study, e.g. config/study/paper.yaml, which has the defaults")
      .option("seed", "N", "seed of down-sampling, forest and bootstrap; default: the plan's")
      .option("threads", "N",
              "number of threads; default: one for each core; the results do not depend on it")
      .flag("paper-only", "leave out what is not in the paper: harder splits, further schemes")
      .flag("no-figures", "write results.json and the tables only");
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

fsr::study::StudyProblem problemOf(const fsr::settings::CommandLine& line, const ToolProgress& progress) {
  if (line.has("simulation") == !line.files().empty()) {
    throw fsr::settings::InputError("study: give either bags or --simulation FILE");
  }
  fsr::study::StudyProblem problem;
  problem.plan = planOf(line);
  if (!line.has("simulation")) {
    problem.recordings = readBags(bagReadOptions(line), line.files(), progress);
    return problem;
  }
  fsr::simulation::SimulationSettings settings =
      fsr::simulation::readSimulationFile(line.text("simulation", ""));
  settings.seed = static_cast<std::uint64_t>(
      line.integer("simulation-seed", static_cast<std::int64_t>(settings.seed), {0, 9e15, ""}));
  problem.simulation = settings.name;
  problem.recordings = fsr::simulation::simulateSession(settings);
  return problem;
}

void write(const fs::path& folder, const fsr::study::StudyResult& result) {
  fsr::settings::replaceFile((folder / "results.json").string(), fsr::report::studyJson(result));
  fs::create_directories(folder / "tables");
  for (const auto& [name, content] : fsr::report::studyTables(result)) {
    fsr::settings::replaceFile((folder / "tables" / name).string(), content);
  }
}

}  // namespace

int studyTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = studyOptions();
  if (!line.parse(argc, argv, out)) return 0;
  const fs::path folder = outputFolder(line.requiredText("output"));
  line.requireWritable((folder / "results.json").string(), fsr::settings::file_kind::kJson);
  const ToolProgress progress = toolProgress();
  const fsr::study::StudyResult result = fsr::study::study(
      problemOf(line, progress), [&](const std::string& stage, std::size_t done, std::size_t total) {
        progress(stage, total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1);
      });
  out << fsr::report::studyText(result);
  write(folder, result);
  out << "\nResults written to " << (folder / "results.json").string() << '\n';
  if (line.has("no-figures")) return 0;
  const int status = figuresDrawn("study.py", {folder.string()}, std::cerr);
  if (status == 0) out << "Report written to " << (folder / "report.html").string() << std::endl;
  return status;
}

}  // namespace fsr_ros
