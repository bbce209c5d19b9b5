#include "ros/tools/tools.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/rescue_bag.h"
#include "ros/programs/sibling_program.h"
#include "ros/tools/tool_options.h"
#include "session/day_report.h"
#include "session/plan.h"
#include "session/session_files.h"
#include "settings/command_line.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;
using fsr::session::DayPart;
using fsr::session::DayReport;
using fsr::settings::InputError;
using Words = std::vector<std::string>;

constexpr int kRefused = 1;  // exit status if a part has no result, or a bag of the session is not in it

fsr::settings::CommandLine dayReportOptions() {
  fsr::settings::CommandLine line(
      "day_report", "DIR",
      "Writes the report of a conducted session. It says what was recorded, how good the calibration is, "
      "what "
      "the sheet does that the simulation lacks, and what to record next. DIR is the folder of the session. "
      "check_bag, train and discrepancy are run on its bags. DIR gets the page PLAN_report.html, which needs "
      "no network, the calibration PLAN_calibration.h5, and the results of the tools in the folder "
      "PLAN_report. session.launch starts day_report by itself.\n"
      "Exit status: 0; 1 if a tool gave no result or a bag could not be closed, as the "
      "report then says; 2 if there is no report.");
  line.input("plan", "FILE",
             "plan of the session; default: PLAN_plan.yaml in DIR, which the conductor writes")
      .option("surfaces", "DIR",
              "with --plan: folder of its surface files; default: ../surfaces, seen from it")
      .option("transducer", "PA", "standard uncertainty of the chamber's transducer [Pa], for train")
      .input("simulation", "FILE", "simulation that discrepancy starts from");
  return line;
}

std::string contentOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string commandOf(const std::string& tool, const Words& words) {
  std::string command = "rosrun fsr_pressure_map " + tool;
  for (const std::string& word : words) command += " " + shellWord(word);
  return command;
}

// Runs the tools in the folder of the session.
class Parts {
 public:
  Parts(std::string folder, std::string results) : folder_(std::move(folder)), results_(std::move(results)) {
    fs::create_directories(fs::path(folder_) / results_);
  }

  // `json`: what the tool writes, seen from the folder; empty = nothing. What an earlier run left is removed,
  // so that it cannot pass for a result of this one.
  DayPart run(const std::string& tool, const Words& words, const std::string& json) const {
    DayPart part;
    part.command = commandOf(tool, words);
    if (!json.empty()) fs::remove(fs::path(folder_) / json);
    const fs::path stem = fs::path(folder_) / results_ / tool;
    const ProgramFiles files{folder_, stem.string() + ".txt", stem.string() + ".log"};
    try {
      auto program = startProgram(siblingProgram(tool), words, files);
      program.wait();
      part.printed = contentOf(files.output);
      part.refused = whyItFailed(program, files.errors);
      if (part.refused.empty() && !json.empty())
        part.result = fsr::session::Json::parse(contentOf(fs::path(folder_) / json));
    } catch (const fsr::session::Json::exception&) {
      part.refused = json + ": is no complete JSON";
    } catch (const InputError& error) {
      part.refused = error.what();
    }
    return part;
  }

  std::string in(const std::string& name) const { return (fs::path(results_) / name).string(); }

 private:
  std::string folder_, results_;
};

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void runTools(const fsr::settings::CommandLine& line, const std::string& folder, DayReport& day) {
  const Parts parts(folder, fsr::session::sessionFile(day.plan.name, fsr::session::kResultsFolder));
  const Words bags = bagsOf(day);
  if (bags.empty()) {
    day.check.refused = day.training.refused = day.discrepancy.refused =
        "no bag of this session is in " + folder;
    return;
  }
  const ToolProgress progress = toolProgress();
  progress("check_bag", 0);
  day.check = parts.run("check_bag", bags, "");
  progress("train", 0.1);
  Words words = bags + Words{"--output", day.calibration, "--details", "--report", parts.in("training.json")};
  if (line.has("transducer")) words = words + Words{"--transducer", line.text("transducer", "")};
  day.training = parts.run("train", words, parts.in("training.json"));
  progress("discrepancy", 0.4);
  words = bags + Words{"--output", parts.in("discrepancy"), "--no-report"};
  if (line.has("simulation"))
    words = words + Words{"--simulation", fs::absolute(line.text("simulation", "")).string()};
  day.discrepancy = parts.run("discrepancy", words, parts.in("discrepancy/results.json"));
}

DayReport recordOf(const fsr::settings::CommandLine& line, const std::string& folder) {
  std::string plan_name;
  if (line.has("plan"))
    plan_name = fsr::session::readPlanFile(line.text("plan", ""), line.text("surfaces", "")).name;
  const fs::path state_file = fs::path(folder) / fsr::session::stateFileIn(folder, plan_name);
  const fsr::session::ConductorState state = fsr::session::readState(state_file.string());
  const std::string plan_file =
      line.text("plan", fsr::session::sessionFile(state.plan, fsr::session::kPlanFile, folder));
  if (!fs::exists(plan_file))
    throw InputError(
        plan_file +
        ": is missing, so that the steps of the session are not known; give its plan with --plan");
  const auto plan = fsr::session::readPlanFile(plan_file, line.text("surfaces", ""));
  const RescuedSession rescued = rescueSession(folder, plan.name);
  DayReport day = fsr::session::dayOf(plan, state, folder);
  day.closed_now = rescued.closed;
  day.not_closed = rescued.open;
  return day;
}

// Whether train accepts it is known only to train; what is no number is refused here, before all the work.
void checkOptions(const fsr::settings::CommandLine& line) {
  line.number("transducer", 0, {0, 1e7, "Pa"});
  if (line.has("surfaces") && !line.has("plan"))
    throw InputError("--surfaces is the folder of the surfaces of --plan; give both");
}

}  // namespace

int dayReportTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = dayReportOptions();
  if (!line.parse(argc, argv, out)) return 0;
  if (line.files().size() != 1) {
    throw InputError(line.files().empty() ? "no DIR is given; see day_report --help"
                                          : line.files()[1] + ": give one folder");
  }
  checkOptions(line);
  const std::string folder = fs::absolute(line.files().front()).lexically_normal().string();
  DayReport day = recordOf(line, folder);
  const std::string page = fsr::session::sessionFile(day.plan.name, fsr::session::kReportFile, folder);
  fsr::settings::requireReplaceable(page, fsr::settings::file_kind::kPage);
  runTools(line, folder, day);
  fsr::settings::replaceFile(page, fsr::session::dayHtml(day));
  for (const std::string& sentence : day.closed_now) out << sentence << '\n';
  for (const std::string& sentence : day.not_closed) out << "left out: " << sentence << '\n';
  bool complete = day.not_closed.empty();
  for (const auto& [tool, part] : {std::pair{"check_bag", &day.check}, std::pair{"train", &day.training},
                                   std::pair{"discrepancy", &day.discrepancy}}) {
    if (part->refused.empty()) continue;
    complete = false;
    out << tool << " gave no result: " << part->refused << '\n';
  }
  out << "Report: " << page << std::endl;
  return complete ? 0 : kRefused;
}

}  // namespace fsr_ros
