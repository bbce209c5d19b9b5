#include "ros/tools/discrepancy_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "dataset/count_readers.h"
#include "discrepancy/prove/recompute_gap.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/discrepancy_report.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_walk.h"
#include "ros/bags/resource_path.h"
#include "ros/tools/tool_options.h"
#include "settings/number_text.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "settings/sha256.h"
#include "settings/text.h"
#include "simulation/taxel_curves.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

std::string heading(const fsr::discrepancy::DiscrepancyReport& report) {
  std::string text = report.sentence + "\nBy discrepancy " + report.version + ", seed " +
                     std::to_string(report.seed) + ", from";
  for (const fsr::discrepancy::InputUse& input : report.inputs)
    text += "\n  " + input.file + " " + input.sha256;
  return text;
}

// Writes a simulation and, if it has them, the curves of its taxels.
void writeSimulation(const fsr::simulation::SimulationSettings& settings, const std::string& folder,
                     const std::string& name, const std::string& head,
                     const fsr::simulation::ValueRemarks& remarks) {
  if (settings.taxel_curves) {
    fsr::settings::replaceFile(folder + "/" + settings.taxel_curves_file,
                               fsr::simulation::taxelCurvesText(*settings.taxel_curves));
  }
  fsr::settings::replaceFile(folder + "/" + name, fsr::simulation::simulationText(settings, head, remarks));
}

}  // namespace

std::map<std::string, std::string> discrepancyFiles() {
  using fsr::settings::kindOf;
  const std::string simulation = kindOf("simulation: x");
  return {{"results.json", fsr::settings::file_kind::kJson},
          {"base.yaml", simulation},
          {"simulation.yaml", simulation},
          {"prediction.yaml", kindOf("verdict_sha256: x")},
          {"verdict.yaml", kindOf("verdict: x")}};
}

void writeDiscrepancy(const fsr::discrepancy::DiscrepancyReport& report, const std::string& folder,
                      const std::vector<fsr::dataset::Recording>& recordings) {
  const std::string figures = outputFolder(folder + "/figures");
  for (const auto& [name, table] : fsr::report::discrepancyTables(report))
    fsr::settings::replaceFile(figures + "/" + name, table);
  fsr::settings::replaceFile(folder + "/results.json", fsr::report::discrepancyJson(report));
  writeSimulation(
      report.base, folder, "base.yaml",
      "The simulation without the effects that were found, fitted to the recordings.\n" + heading(report),
      {});
  writeSimulation(report.added, folder, "simulation.yaml", heading(report), fsr::report::fitRemarks(report));
  const std::string verdict = fsr::report::verdictText(report);
  fsr::report::FrozenPrediction frozen{report.prediction,
                                       fsr::settings::sha256(verdict.data(), verdict.size()),
                                       fsr::dataset::pacesOf(recordings)};
  for (const fsr::dataset::Recording& one : recordings) frozen.readings_sha256.push_back(readingsSha256(one));
  fsr::settings::replaceFile(folder + "/prediction.yaml", fsr::report::predictionText(frozen));
  fsr::settings::replaceFile(folder + "/verdict.yaml", verdict);
}

std::string readingsSha256(const fsr::dataset::Recording& recording) {
  fsr::settings::Sha256 sum;
  fsr::dataset::ScanCounts counts(recording);
  const std::size_t bytes = recording.layout.size.taxels() * sizeof(std::uint16_t);
  for (std::size_t i = 0; i < recording.scans(); ++i) sum.add(counts[i], bytes);
  return sum.hexadecimal();
}

StoredPrediction readPredictionBeside(const std::string& verdict_path) {
  const std::string folder = fs::absolute(verdict_path).parent_path();
  StoredPrediction stored{fsr::report::readPrediction(folder + "/prediction.yaml"),
                          fsr::simulation::readSimulationFile(folder + "/base.yaml")};
  if (fsr::settings::sha256OfFile(verdict_path) != stored.frozen.verdict_sha256) {
    throw fsr::settings::InputError(verdict_path +
                                    ": this file has changed since prediction.yaml was written with it; an "
                                    "edited verdict cannot be confirmed, "
                                    "so run discrepancy again");
  }
  return stored;
}

ShowLedger::ShowLedger() : folder_(rosHome() + "/fsr_pressure_map/show_opened") {}

int ShowLedger::open(const std::string& sha256, std::uint64_t seed) const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const std::string path = folder_ + "/" + sha256;
  {
    // One short line in one write, so that programs running at the same time do not mix their lines.
    std::ofstream ledger(path, std::ios::app);
    ledger << fsr::settings::nowText() + " seed " + std::to_string(seed) + "\n" << std::flush;
    if (!ledger) {
      throw fsr::settings::InputError(
          path +
          ": cannot be written, but it counts how often the hold-out cycles of the bag "
          "were used; set ROS_HOME to a folder that can be written");
    }
  }
  std::ifstream lines(path);
  return static_cast<int>(
      std::count(std::istreambuf_iterator<char>(lines), std::istreambuf_iterator<char>(), '\n'));
}

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
