#include "ros/tools/simulate_tool.h"

#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/effect_list.h"
#include "report/portrait_json.h"
#include "ros/bags/simulated_bags.h"
#include "ros/tools/figure_script.h"
#include "settings/command_line.h"
#include "settings/replace_file.h"
#include "simulation/effects/effect_library.h"
#include "simulation/portrait.h"
#include "simulation/simulation_text.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = "truth.yaml";
constexpr int kFiguresMissing = 3;  // exit status where all is there but the figures

fsr::settings::CommandLine options() {
  fsr::settings::CommandLine line(
      "simulate", "--simulation FILE [--drive BAG...] --output DIR",
      "Writes bags of a simulated rig: through the session of the simulation file, or on the "
      "recorded pressure, surfaces and temperature of real bags. What the rig really is "
      "stands in truth.yaml beside them and nowhere else.");
  line.option("simulation", "FILE", "the rig, e.g. config/simulation/bench.yaml")
      .option("output", "DIR", "folder to write to; it is made where it is not there")
      .option("drive", "BAG", "run the model on these bags, in time order, instead of the session")
      .option("namespace", "NS", "the sensor's namespace, where a bag holds several")
      .option("seed", "N", "instead of the file's: another sheet and other noise")
      .option("effect", "ID", "enable this effect, at its usual values where the file does not have it")
      .option("state", "FILE",
              "go on from the state that another run saved: what the sheet remembers, and when")
      .option("save-state", "FILE", "save it at the end")
      .flag("plot", "draw what the rig's effects do, or --effect alone, instead of writing bags")
      .flag("list-effects", "describe every effect, or --effect alone, and leave");
  return line;
}

fsr::simulation::SimulationSettings settingsOf(const fsr::settings::CommandLine& line) {
  fsr::simulation::SimulationSettings settings =
      fsr::simulation::readSimulationFile(line.requiredText("simulation"));
  settings.seed = static_cast<std::uint64_t>(
      line.integer("seed", static_cast<std::int64_t>(settings.seed), {0, 9e15, ""}));
  return line.has("effect") ? fsr::simulation::withEffect(settings, line.text("effect", "")) : settings;
}

std::string folderOf(const fsr::settings::CommandLine& line) {
  const fs::path folder = fs::absolute(line.requiredText("output")).lexically_normal();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw fsr::settings::InputError(folder.string() + ": the folder cannot be made (" + error.message() +
                                    "); give another one with --output");
  }
  return folder;
}

/// A folder that was made and then stayed empty, because nothing came of it, goes again.
class TidyFolder {
 public:
  explicit TidyFolder(const fsr::settings::CommandLine& line)
      : is_new_(!fs::exists(line.requiredText("output"))), path_(folderOf(line)) {}
  ~TidyFolder() {
    std::error_code ignored;
    if (is_new_ && fs::is_empty(path_, ignored)) fs::remove(path_, ignored);
  }
  TidyFolder(const TidyFolder&) = delete;
  TidyFolder& operator=(const TidyFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  bool is_new_;
  std::string path_;
};

/// Recorded bags must not be lost under the name of simulated ones.
void refuseBagsOfOthers(const fs::path& folder) {
  if (fs::exists(folder / kTruth)) return;
  for (const auto& file : fs::directory_iterator(folder)) {
    if (file.path().extension() != ".bag") continue;
    throw fsr::settings::InputError(folder.string() + ": holds " + file.path().filename().string() +
                                    ", which no simulation wrote; give another folder with --output");
  }
}

std::vector<std::string> bagsOf(const fsr::settings::CommandLine& line) {
  std::vector<std::string> bags = line.files();
  if (line.has("drive")) {
    bags.insert(bags.begin(), line.text("drive", ""));
  } else if (!bags.empty()) {
    throw fsr::settings::InputError(bags.front() + ": bags are given with --drive, to run the model on them");
  }
  return bags;
}

std::string remarkOf(const fsr::settings::CommandLine& line, const std::vector<std::string>& driving) {
  std::string remark = "What the simulated rig behind the bags beside this file really is.";
  if (line.has("state"))
    remark += "\nIt went on from " + fs::path(line.text("state", "")).filename().string() + ".";
  for (const std::string& bag : driving) remark += "\nDriven by " + fs::path(bag).filename().string() + ".";
  return remark;
}

void writeBags(const fsr::settings::CommandLine& line, const fsr::simulation::SimulationSettings& settings,
               std::ostream& out) {
  const std::vector<std::string> driving = bagsOf(line);
  const std::string saved = line.text("save-state", "");
  if (!saved.empty()) fsr::settings::requireReplaceable(saved);
  SimulatedBags bags;
  const TidyFolder folder(line);
  bags.output = folder.path();
  refuseBagsOfOthers(bags.output);
  bags.progress = [&](const std::string& path) { out << path << std::endl; };
  if (line.has("state")) {
    bags.state = fsr::simulation::readRigState(fsr::settings::Settings::fromFile(line.requiredText("state")));
  }
  const SimulatedRun run = driving.empty()
                               ? writeSessionBags(settings, bags)
                               : writeDrivenBags(settings, {driving, line.text("namespace", "")}, bags);
  for (const std::string& warning : run.warnings) out << warning << std::endl;
  const fs::path truth = fs::path(bags.output) / kTruth;
  fsr::settings::replaceFile(truth, simulationText(run.rig, remarkOf(line, driving)));
  out << truth.string() << std::endl;
  if (saved.empty()) return;
  fsr::settings::replaceFile(saved, stateText(run.state));
  out << saved << std::endl;
}

int drawPlot(const fsr::settings::CommandLine& line, const fsr::simulation::SimulationSettings& settings,
             std::ostream& out) {
  const std::string id = line.text("effect", "");
  fsr::simulation::SimulationSettings titled = settings;
  if (!id.empty()) titled.name = id;
  const fs::path folder = folderOf(line), data = folder / (titled.name + ".json"),
                 stem = folder / titled.name;
  const auto before = id.empty() ? coreOf(settings) : withoutEffect(settings, id);
  fsr::simulation::Portrait portrait = portray(titled, before);
  if (!id.empty()) portrait.title += ": " + fsr::simulation::findEffect(id)->info.summary;
  fsr::settings::replaceFile(data, fsr::report::portraitJson(portrait));
  out << data.string() << std::endl;
  try {
    drawFigures("simulation.py", {data, stem});
  } catch (const fsr::settings::InputError& error) {
    out << error.what() << std::endl;
    return kFiguresMissing;
  }
  out << stem.string() + ".png" << std::endl << stem.string() + ".pdf" << std::endl;
  return 0;
}

std::string listOf(const std::string& id) {
  if (id.empty()) return fsr::report::effectListText();
  const fsr::simulation::EffectEntry* entry = fsr::simulation::findEffect(id);
  if (!entry)
    throw fsr::settings::InputError("--effect is " + id +
                                    ", but no effect has that name; see --list-effects");
  return fsr::report::effectText(entry->info);
}

}  // namespace

int simulateTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = options();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  if (line.has("list-effects")) {
    out << listOf(line.text("effect", ""));
    return 0;
  }
  const fsr::simulation::SimulationSettings settings = settingsOf(line);
  if (line.has("plot")) return drawPlot(line, settings, out);
  writeBags(line, settings, out);
  return 0;
}

}  // namespace fsr_ros
