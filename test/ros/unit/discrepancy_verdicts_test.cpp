// Every verdict, obtained as a user does: bags in, verdict.yaml out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "discrepancy/planted.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_writer.h"
#include "ros/tools/tools.h"
#include "settings/replace_file.h"
#include "simulation/settings_text.h"
#include "statistics/random_stream.h"
#include "support/folder_test.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class DiscrepancyVerdicts : public test_support::FolderTest {
 protected:
  void SetUp() override { ::setenv("ROS_HOME", folder_.c_str(), 1); }

  /// Writes the bags of a session to a folder, and the simulation without the hidden effect beside them.
  std::string session(const std::string& name, const fsr::discrepancy::DiscrepancyProblem& problem) const {
    fs::create_directories(folder_ / name);
    for (const fsr::dataset::Recording& recording : problem.recordings)
      writeBag(path(name + "/" + recording.name), recording);
    fsr::settings::replaceFile(path("simulation.yaml"), fsr::simulation::simulationText(problem.simulation));
    return path(name);
  }
  static std::string run(Words words) {
    words.insert(words.begin(), "--no-report");
    return test_support::runTool(discrepancyTool, "discrepancy", words).said();
  }
  fsr::report::VerdictFile verdict(const Words& bags, const Words& more = {}) const {
    Words words = {"--simulation", path("simulation.yaml"), "--output", path("out")};
    words.insert(words.end(), bags.begin(), bags.end());
    words.insert(words.end(), more.begin(), more.end());
    const std::string said = run(words);
    EXPECT_NE(said.find("Written: "), std::string::npos) << said;
    return fsr::report::readVerdict(path("out/verdict.yaml"));
  }
  fsr::report::VerdictFile hidden(const std::string& rig, const std::string& effects,
                                  const Words& more = {}) const {
    return verdict({session("bags", fsr::discrepancy::planted::problem(rig, effects))}, more);
  }
};

const std::string kLoop = "  hysteresis: {loop_width: 0.05}\n";

TEST_F(DiscrepancyVerdicts, None) {
  const fsr::report::VerdictFile file = hidden(fsr::discrepancy::planted::kTwoSpeeds, "");
  EXPECT_EQ(file.verdict, "none");
  EXPECT_TRUE(file.credible_set.empty());
}

TEST_F(DiscrepancyVerdicts, NamedOne) {
  const fsr::report::VerdictFile file = hidden(fsr::discrepancy::planted::kTwoSpeeds, kLoop);
  EXPECT_EQ(file.verdict, "named");
  EXPECT_EQ(file.effects, Words{"hysteresis"});
}

TEST_F(DiscrepancyVerdicts, NamedTwo) {
  fsr::report::VerdictFile file =
      hidden(fsr::discrepancy::planted::kTwoSpeeds, kLoop + "  time_skew: {delay: 0.5}\n");
  EXPECT_EQ(file.verdict, "named");
  std::sort(file.effects.begin(), file.effects.end());
  EXPECT_EQ(file.effects, (Words{"hysteresis", "time_skew"}));
}

TEST_F(DiscrepancyVerdicts, Unknown) {
  const fsr::report::VerdictFile file = hidden(fsr::discrepancy::planted::kTwoSpeeds,
                                               "  time_skew: {delay: 0.3}\n", {"--without", "time_skew"});
  EXPECT_EQ(file.verdict, "unknown");
  EXPECT_TRUE(file.effects.empty());
}

TEST_F(DiscrepancyVerdicts, WrongForm) {
  const fsr::report::VerdictFile file = verdict({session("bags", fsr::discrepancy::planted::crossedLoop())});
  EXPECT_EQ(file.verdict, "wrong_form");
  EXPECT_EQ(file.effects, Words{"hysteresis"});
}

TEST_F(DiscrepancyVerdicts, NotIdentifiable) {
  const fsr::report::VerdictFile file =
      hidden(fsr::discrepancy::planted::kTwoSpeeds, "", {"--ask", "crosstalk"});
  EXPECT_EQ(file.verdict, "not_identifiable");
  EXPECT_EQ(file.credible_set, (std::vector<Words>{{"crosstalk"}}));
}

// A single speed cannot distinguish a loop from a short memory. The experiment that the verdict recommends
// identifies the right one. The prediction made before it is confirmed, and it fails on a rig with a short
// memory instead.
TEST_F(DiscrepancyVerdicts, AmbiguousUntilTheRecommendedExperimentIsRun) {
  const std::string first =
      session("one_speed", fsr::discrepancy::planted::problem(fsr::discrepancy::planted::kOneSpeed, kLoop));
  const fsr::report::VerdictFile before = verdict({first});
  ASSERT_EQ(before.verdict, "ambiguous");
  EXPECT_EQ(before.credible_set.front(), Words{"hysteresis"});
  EXPECT_GE(before.credible_set.size(), 2u);
  const std::string experiment =
      session("two_speeds", fsr::discrepancy::planted::problem(fsr::discrepancy::planted::kTwoSpeeds, kLoop));
  const std::string memory =
      session("memory", fsr::discrepancy::planted::problem(fsr::discrepancy::planted::kTwoSpeeds,
                                                           "  creep: {per_decade: 0.05, slowest: 100}\n"));
  const std::string confirmed = run({"--confirm", path("out/verdict.yaml"), experiment});
  EXPECT_EQ(confirmed.find("Confirmed: hysteresis"), 0u) << confirmed;
  EXPECT_EQ(confirmed.find("ame protocol"), std::string::npos) << confirmed;
  const std::string refuted = run({"--confirm", path("out/verdict.yaml"), memory});
  EXPECT_EQ(refuted.find("Not confirmed: "), 0u) << refuted;
  const fsr::report::VerdictFile after = verdict({first, experiment});
  EXPECT_EQ(after.verdict, "named");
  EXPECT_EQ(after.effects, Words{"hysteresis"});
}

}  // namespace
}  // namespace fsr_ros
