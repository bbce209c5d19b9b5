#include "ros/tools/recompute_gap_tool.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "discrepancy/prove/recompute_gap.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/tool_options.h"
#include "settings/number_text.h"
#include "settings/yaml_text.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr int kDigits = 8;

// A sheet remembers every bag, so all of them are needed.
void requireAll(const std::vector<fsr::dataset::Recording>& recordings,
                const fsr::report::VerdictFile& verdict, const std::string& path) {
  const auto given = [&](const fsr::discrepancy::InputUse& input) {
    return std::any_of(recordings.begin(), recordings.end(), [&](const fsr::dataset::Recording& recording) {
      return recording.sha256 == input.sha256;
    });
  };
  for (const fsr::discrepancy::InputUse& input : verdict.inputs) {
    if (given(input)) continue;
    throw fsr::settings::InputError(path + ": was made from " + input.file +
                                    ", which is not among the bags; give exactly the bags of the verdict");
  }
  if (recordings.size() != verdict.inputs.size()) {
    throw fsr::settings::InputError(path + ": was made from " + std::to_string(verdict.inputs.size()) +
                                    " bags, but " + std::to_string(recordings.size()) +
                                    " are given; give exactly the bags of the verdict");
  }
}

// The bags of the verdict. A folder may hold other bags beside them.
std::vector<std::string> bagsOfVerdict(const std::vector<std::string>& given,
                                       const fsr::report::VerdictFile& verdict) {
  std::vector<std::string> bags;
  for (const std::string& path : given) {
    for (const std::string& bag : bagsIn({path})) {
      const auto is_it = [&](const auto& input) { return input.file == fs::path(bag).filename(); };
      if (bag == path || std::any_of(verdict.inputs.begin(), verdict.inputs.end(), is_it))
        bags.push_back(bag);
    }
  }
  return bags;
}

std::string percentOf(double gap) {
  return std::isfinite(gap) ? fsr::settings::roundedText(100 * gap, kDigits) + " % of full scale"
                            : "not known";
}

double statedOn(const fsr::report::VerdictFile& verdict, const std::string& surface, bool after) {
  for (const fsr::discrepancy::SurfaceGap& one : verdict.gap_surfaces) {
    if (one.surface == surface) return after ? one.after : one.before;
  }
  return NAN;
}

}  // namespace

int printRecomputedGap(const std::string& path, const DrivingBags& bags, std::ostream& out) {
  const fsr::report::VerdictFile verdict = fsr::report::readVerdict(path);
  if (verdict.hold_out.empty())
    throw fsr::settings::InputError(path + ": nothing was held out, so there is no gap to recompute");
  const std::vector<fsr::dataset::Recording> recordings =
      readBags(bags.how, bagsOfVerdict(bags.paths, verdict), toolProgress(), true);
  requireAll(recordings, verdict, path);
  const fs::path folder = fs::absolute(path).parent_path();
  const std::pair<const char*, bool> files[] = {{"base.yaml", false}, {"simulation.yaml", true}};
  for (const auto& [file, after] : files) {
    const fsr::discrepancy::RecomputedGap gap = fsr::discrepancy::recomputeGap(
        recordings, verdict.hold_out, fsr::simulation::readSimulationFile((folder / file).string()),
        told(std::string("simulating ") + file, toolProgress()));
    out << "Gap of " << file << ": " << percentOf(gap.rms) << ", stated "
        << percentOf(after ? verdict.gap_after : verdict.gap_before) << std::endl;
    for (const auto& [surface, rms] : gap.surfaces)
      out << "  on " << surface << ": " << percentOf(rms) << ", stated "
          << percentOf(statedOn(verdict, surface, after)) << std::endl;
  }
  return 0;
}

std::string recomputeCommand(const std::string& verdict, const DrivingBags& bags) {
  std::string command = "rosrun fsr_pressure_map simulate --gap " + shellWord(verdict);
  if (!bags.how.topics.empty()) command += " --namespace " + shellWord(bags.how.topics);
  if (bags.how.ambient_pressure)
    command += " --ambient " + fsr::settings::numberText(*bags.how.ambient_pressure);
  command += " --drive";
  for (const std::string& path : bags.paths) command += " " + shellWord(path);
  return command;
}

}  // namespace fsr_ros
