#include "ros/tools/tools.h"

#include <filesystem>
#include <functional>
#include <optional>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/effect_list.h"
#include "ros/bags/simulated_bags.h"
#include "ros/tools/discrepancy_files.h"
#include "ros/tools/tool_options.h"
#include "session/plan.h"
#include "session/plan_steps.h"
#include "settings/command_line.h"
#include "settings/progress.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "simulation/effects/effect_library.h"
#include "simulation/portrait.h"
#include "simulation/settings_text.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = "truth.yaml";

fsr::settings::CommandLine simulateOptions() {
  fsr::settings::CommandLine line(
      "simulate", "--simulation FILE [--drive BAG...] --output DIR  |  --gap verdict.yaml --drive BAG...",
      "Writes bags of a simulated rig. The pressure, surfaces and temperature are those of the session in "
      "the "
      "simulation file, or those recorded in real bags. The true settings of the rig are in truth.yaml "
      "beside "
      "the bags, and not in the bags.");
  line.input("simulation", "FILE", "settings of the rig, e.g. config/simulation/bench.yaml")
      .output("output", "DIR", "folder to write to; it is created if it does not exist")
      .input(
          "drive", "BAG",
          "run the simulation on these bags, in time order, instead of the session; a folder stands for the "
          "bags in it")
      .input("gap", "FILE",
             "a verdict.yaml: recompute its gap on the bags of --drive, with base.yaml and simulation.yaml "
             "beside "
             "it; writes nothing")
      .input("plan", "FILE",
             "run the surfaces and the program of this plan (plan_session) instead of the session")
      .option("seed", "N", "seed instead of the file's: another sheet and other noise")
      .option("sheets", "N", "simulate N sheets, of the seeds from --seed on, each in a folder sheet_SEED")
      .option("effect", "ID", "enable this effect, with its usual values if the file does not set them")
      .input("state", "FILE", "continue from the state of the sheet that another run saved")
      .output("save-state", "FILE", "save the state of the sheet at the end")
      .flag("plot", "draw the effects of the rig, or --effect alone, instead of writing bags")
      .flag("list-effects", "describe every effect, or --effect alone, and exit");
  return addBagOptions(line);
}

// The session of a plan instead of that of the simulation.
void runPlan(const std::string& path, fsr::simulation::SimulationSettings& settings) {
  settings.session = fsr::session::simulatedStations(fsr::session::readPlanFile(path));
  for (const fsr::simulation::Station& station : settings.session) {
    try {
      fsr::matrix::requireFit(station.surface, settings.layout.size);
    } catch (const fsr::settings::InputError& error) {
      throw fsr::settings::InputError(path + ": " + error.what() + "; the matrix is that of " +
                                      settings.origin);
    }
  }
}

fsr::simulation::SimulationSettings settingsOf(const fsr::settings::CommandLine& line) {
  fsr::simulation::SimulationSettings settings =
      fsr::simulation::readSimulationFile(line.requiredText("simulation"));
  settings.seed = static_cast<std::uint64_t>(
      line.integer("seed", static_cast<std::int64_t>(settings.seed), {0, 9e15, ""}));
  if (line.has("plan")) runPlan(line.text("plan", ""), settings);
  return line.has("effect") ? fsr::simulation::withEffect(settings, line.text("effect", "")) : settings;
}

// Creates the output folder. The destructor removes it again if it is new and still empty.
class TidyFolder {
 public:
  explicit TidyFolder(const fsr::settings::CommandLine& line)
      : is_new_(!fs::exists(line.requiredText("output"))), path_(outputFolder(line.requiredText("output"))) {}
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

// Throws if the folder has bags that no simulation wrote, so that recorded bags are not overwritten.
void refuseRecordedBags(const fs::path& folder) {
  if (fs::exists(folder / kTruth)) return;
  for (const auto& file : fs::directory_iterator(folder)) {
    if (file.path().extension() != ".bag") continue;
    throw fsr::settings::InputError(folder.string() + ": holds " + file.path().filename().string() +
                                    ", which was not written by simulate; give another folder with --output");
  }
}

std::vector<std::string> drivingBags(const fsr::settings::CommandLine& line) {
  std::vector<std::string> bags = line.files();
  if (line.has("drive")) {
    bags.insert(bags.begin(), line.text("drive", ""));
  } else if (!bags.empty()) {
    throw fsr::settings::InputError(bags.front() + ": to run the simulation on bags, give them with --drive");
  }
  return bags;
}

// Prints the files that are written, and on a terminal how far the simulation is.
class Display {
 public:
  explicit Display(std::ostream& out) : out_(out) {}

  void print(const std::string& path) {
    line_.clear();
    out_ << path << std::endl;
  }
  // Sheet `part` of `parts` comes next.
  void begin(std::size_t part, std::size_t parts) {
    part_ = static_cast<double>(part);
    parts_ = static_cast<double>(parts);
  }
  std::function<void(const std::string& step, double share)> told() {
    return [this](const std::string& step, double share) { line_.report(step, (part_ + share) / parts_); };
  }

 private:
  std::ostream& out_;
  fsr::settings::Progress line_;
  double part_ = 0, parts_ = 1;
};

std::string remarkOf(const fsr::settings::CommandLine& line, const std::vector<std::string>& driving) {
  std::string remark = "True settings of the simulated rig that wrote the bags in this folder.";
  if (line.has("state"))
    remark += "\nContinued from " + fs::path(line.text("state", "")).filename().string() + ".";
  for (const std::string& bag : driving) remark += "\nDriven by " + fs::path(bag).filename().string() + ".";
  return remark;
}

int recompute(const fsr::settings::CommandLine& line, std::ostream& out) {
  const DrivingBags bags{drivingBags(line), bagReadOptions(line)};
  if (bags.paths.empty()) throw fsr::settings::InputError("--gap: give the bags of the verdict with --drive");
  return printRecomputedGap(line.text("gap", ""), bags, out);
}

void writeBags(const fsr::settings::CommandLine& line, const fsr::simulation::SimulationSettings& settings,
               std::ostream& out) {
  const DrivingBags driving{bagsIn(drivingBags(line)), bagReadOptions(line)};
  if (line.has("plan") && !driving.paths.empty())
    throw fsr::settings::InputError("--plan and --drive both say what the chamber does; give one of them");
  const std::string saved = line.text("save-state", "");
  if (!saved.empty()) fsr::settings::requireReplaceable(saved, fsr::settings::kindOf("rig_state: 1"));
  SimulatedBags bags;
  const TidyFolder folder(line);
  bags.output = folder.path();
  refuseRecordedBags(bags.output);
  line.requireWritable(fs::path(bags.output) / kTruth, fsr::settings::kindOf("simulation: x"));
  std::optional<Display> display(out);
  bags.progress = [&](const std::string& path) { display->print(path); };
  bags.told = display->told();
  if (line.has("state")) {
    bags.state = fsr::simulation::readRigState(fsr::settings::Settings::fromFile(line.requiredText("state")));
  }
  const SimulatedRun run =
      driving.paths.empty() ? writeSessionBags(settings, bags) : writeDrivenBags(settings, driving, bags);
  display.reset();  // removes its line
  for (const std::string& warning : run.warnings) out << warning << std::endl;
  const fs::path truth = fs::path(bags.output) / kTruth;
  fsr::settings::replaceFile(truth, simulationText(run.rig, remarkOf(line, driving.paths)));
  out << truth.string() << std::endl;
  if (saved.empty()) return;
  fsr::settings::replaceFile(saved, stateText(run.state));
  out << saved << std::endl;
}

// The session of a new sheet: its bags and their truth.
void writeSheet(const fsr::simulation::SimulationSettings& settings, const fs::path& folder,
                Display& display) {
  fs::create_directories(folder);
  refuseRecordedBags(folder);
  const fs::path truth = folder / kTruth;
  fsr::settings::replaceFile(
      truth,
      simulationText(settings, "True settings of the simulated rig that wrote the bags in this folder."));
  display.print(truth.string());
  SimulatedBags bags;
  bags.output = folder;
  bags.progress = [&](const std::string& path) { display.print(path); };
  bags.told = display.told();
  writeSessionBags(settings, bags);
}

void writeSheets(const fsr::settings::CommandLine& line, const fsr::simulation::SimulationSettings& settings,
                 std::ostream& out) {
  line.refuse({"drive", "state", "save-state", "plot", "gap"},
              "cannot be used with --sheets, which writes the sessions of new sheets");
  drivingBags(line);  // refuses bags without --drive
  const auto sheets = static_cast<std::size_t>(line.integer("sheets", 1, {1, 1e6, ""}));
  const TidyFolder folder(line);
  fsr::simulation::SimulationSettings sheet = settings;
  Display display(out);
  for (std::size_t i = 0; i < sheets; ++i) {
    sheet.seed = settings.seed + i;
    display.begin(i, sheets);
    writeSheet(sheet, fs::path(folder.path()) / ("sheet_" + std::to_string(sheet.seed)), display);
  }
}

int drawPlot(const fsr::settings::CommandLine& line, const fsr::simulation::SimulationSettings& settings,
             std::ostream& out) {
  const std::string id = line.text("effect", "");
  fsr::simulation::SimulationSettings titled = settings;
  if (!id.empty()) titled.name = id;
  const fs::path folder = outputFolder(line.requiredText("output")), data = folder / (titled.name + ".json"),
                 stem = folder / titled.name;
  const auto before = id.empty() ? coreOf(settings) : withoutEffect(settings, id);
  fsr::simulation::Portrait portrait = portray(titled, before);
  if (!id.empty()) portrait.title += ": " + fsr::simulation::findEffect(id)->info.summary;
  line.requireWritable(data);
  fsr::settings::replaceFile(data, fsr::report::portraitJson(portrait));
  out << data.string() << std::endl;
  const int status = figuresDrawn("simulation.py", {data, stem}, out);
  if (status == 0) out << stem.string() + ".png" << std::endl << stem.string() + ".pdf" << std::endl;
  return status;
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
  fsr::settings::CommandLine line = simulateOptions();
  if (!line.parse(argc, argv, out)) return 0;
  if (line.has("list-effects")) {
    out << listOf(line.text("effect", ""));
    return 0;
  }
  if (line.has("gap")) return recompute(line, out);
  const fsr::simulation::SimulationSettings settings = settingsOf(line);
  if (line.has("sheets")) {
    writeSheets(line, settings, out);
  } else if (line.has("plot")) {
    return drawPlot(line, settings, out);
  } else {
    writeBags(line, settings, out);
  }
  return 0;
}

}  // namespace fsr_ros
