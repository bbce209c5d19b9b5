#include "ros/tools/tools.h"

#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/resource_path.h"
#include "ros/bags/surface_folder.h"
#include "session/plan.h"
#include "session/plan_steps.h"
#include "settings/command_line.h"
#include "settings/number_text.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

namespace plans = fsr::session;
using fsr::settings::InputError;

constexpr char kSurfaces[] = "flat,cylinder_5cm,cylinder_7cm,cylinder_9cm,cylinder_11cm,cylinder_13cm";

fsr::settings::CommandLine planSessionOptions() {
  fsr::settings::CommandLine line(
      "plan_session", "--for NAME --minutes N --output PLAN.yaml, or PLAN.yaml [--steps]",
      "Writes a plan for a session at the rig, which fits the time, or describes one. It says what is "
      "needed, how long it takes, and what the recordings can and cannot tell.");
  line.option("for", "NAME", "discrepancy, history, per_curvature or field_check")
      .option("minutes", "N", "time that there is, changes of the surface included")
      .output("output", "FILE", "plan to write")
      .option("surfaces", "NAME,...", std::string("surfaces that there are (") + kSurfaces + ")")
      .option("surface-folder", "DIR", "folder of their files (config/surfaces of this package)")
      .option("peak", "KPA", "largest pressure to measure, gauge (620)")
      .option("chamber-limit", "KPA", "largest pressure of the chamber, gauge (793)")
      .option("change", "MIN", "time to put the sheet on the next surface (3)")
      .flag("thermometer", "the temperature of the sheet will be recorded")
      .option("rows", "N", "rows of the matrix, for surfaces with a curvature for each taxel (7)")
      .option("columns", "N", "columns of the matrix, likewise (10)")
      .option("seed", "N", "seed of the order of the surfaces (1)")
      .flag("steps", "print every step with its time");
  return line;
}

std::string surfaceFolderOf(const fsr::settings::CommandLine& line) {
  return line.has("surface-folder") ? line.text("surface-folder", "")
                                    : resolveResource(SurfaceFolder::shipped());
}

plans::PlanRequest requestIn(const fsr::settings::CommandLine& line) {
  plans::PlanRequest request;
  plans::SessionPlan& like = request.like;
  like.purpose = plans::purposeCalled(line.choice("for", plans::purposeNames(), line.requiredText("for")));
  line.requiredText("minutes");
  request.time = 60 * line.number("minutes", 0, {0, 10080, "min"});
  like.chamber_limit = 1e3 * line.number("chamber-limit", like.chamber_limit / 1e3,
                                         {1, fsr::simulation::kChamberRating / 1e3, "kPa gauge"});
  request.peak = 1e3 * line.number("peak", request.peak / 1e3,
                                   {1, like.chamber_limit / 1e3, "kPa gauge (--chamber-limit)"});
  like.change = 60 * line.number("change", like.change / 60, {0, 1440, "min"});
  like.thermometer = line.has("thermometer");
  like.seed = static_cast<std::uint64_t>(line.integer("seed", 1, {0, 9e15, ""}));
  like.matrix.rows =
      static_cast<std::uint16_t>(line.integer("rows", 7, {1, fsr::matrix::kMaxMatrixSide, ""}));
  like.matrix.columns =
      static_cast<std::uint16_t>(line.integer("columns", 10, {1, fsr::matrix::kMaxMatrixSide, ""}));
  const std::string folder = surfaceFolderOf(line);
  for (const std::string& name : line.list("surfaces", kSurfaces))
    request.surfaces.push_back(
        plans::surfaceInFolder(name, folder, like.matrix, "--surfaces names \"" + name + "\""));
  return request;
}

void describe(const plans::SessionPlan& plan, const fsr::settings::CommandLine& line, std::ostream& out) {
  out << (line.has("steps") ? plans::stepsText(plan) : plans::planReport(plan));
}

void propose(const fsr::settings::CommandLine& line, std::ostream& out) {
  const std::string output = line.requiredText("output");
  line.requireWritable(output, fsr::settings::kindOf("plan: x"));
  const plans::PlanRequest request = requestIn(line);
  plans::ProposedPlan proposed = plans::proposePlan(request);
  proposed.plan.name = std::filesystem::path(output).stem().string();
  fsr::settings::replaceFile(output,
                             plans::planText(proposed.plan, {plans::headline(proposed.plan) + ".",
                                                             "Written by plan_session. `plan_session FILE` "
                                                             "describes it."}));
  describe(proposed.plan, line, out);
  const double whole = plans::sessionDuration(proposed.whole);
  if (whole > plans::sessionDuration(proposed.plan))
    out << "\nThe whole plan for " << plans::name(request.like.purpose) << " takes " << plans::timeText(whole)
        << ".\n";
  out << "\nwritten: " << std::filesystem::absolute(output).lexically_normal().string() << "\n";
}

}  // namespace

int planSessionTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = planSessionOptions();
  if (!line.parse(argc, argv, out)) return 0;
  if (line.files().empty()) {
    propose(line, out);
    return 0;
  }
  if (line.files().size() > 1) throw InputError(line.files()[1] + ": give one plan; see plan_session --help");
  line.refuse({"for", "minutes", "output"}, "is for writing a plan, but " + line.files().front() +
                                                " is one that exists; give either of them");
  const std::string folder = line.has("surface-folder") ? line.text("surface-folder", "") : "";
  describe(plans::readPlanFile(line.files().front(), folder), line, out);
  return 0;
}

}  // namespace fsr_ros
