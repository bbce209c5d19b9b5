#include "ros/tools/tools.h"

#include <unistd.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "support/content_of.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class StudyTool : public test_support::FolderTest {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "plan.yaml")
        << "study: quick\nforest: {trees: 5}\nresamples: 99\nbandwidths: [0.0078125, 0.0625]\n";
  }

  std::string record(double noise = 60) const {
    test_support::SyntheticRig rig;
    rig.surfaces = {{"flat", 0.0}, {"cylinder_13cm", 7.7}, {"cylinder_5cm", 20.0}};
    rig.scans_per_cycle = 60;
    rig.noise = noise;
    fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = 1500000000000000000;
    const std::string path = (folder_ / "session.bag").string();
    writeBag(path, recording);
    return path;
  }

  std::string run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(studyTool, "study", words);
    EXPECT_EQ(run.status, run.error.empty() ? 0 : -1);
    return run.said();
  }
};

TEST_F(StudyTool, WritesResultsTablesFiguresAndAReportThatNeedsNoNetwork) {
  const fs::path output = folder_ / "results";
  const std::string text =
      run({record(), "--plan", (folder_ / "plan.yaml").string(), "--output", output.string()});
  EXPECT_NE(text.find("As published, taxels treated as independent"), std::string::npos) << text;
  EXPECT_NE(text.find((output / "report.html").string()), std::string::npos) << text;
  const std::string report = test_support::contentOf(output / "report.html");
  EXPECT_NE(report.find("data:image/png;base64"), std::string::npos);
  EXPECT_EQ(report.find("http"), std::string::npos);
  EXPECT_NE(report.find("<h2>Error of the map against error of the curvature</h2>"), std::string::npos);
  EXPECT_NE(text.find("Error of the map against error of the curvature"), std::string::npos) << text;
  EXPECT_NE(test_support::contentOf(output / "results.json").find("\"curvature_errors\": [\n"),
            std::string::npos);
  EXPECT_NE(test_support::contentOf(output / "results.json").find("\"headline\""), std::string::npos);
  for (const std::string name : {"fig5_response", "fig6_algorithms", "fig7_methods", "fig8_low_pressure",
                                 "fig9_prediction", "fig10_all_curvatures", "splits", "curvature_errors"}) {
    for (const std::string ending : {".png", ".pdf", ".csv"}) {
      EXPECT_GT(fs::file_size(output / "figures" / (name + ending)), 100u) << name << ending;
    }
  }
  EXPECT_EQ(test_support::contentOf(output / "tables" / "scores.csv").rfind("part,method", 0), 0u);
}

TEST_F(StudyTool, RefusesBagsAndASimulationTogetherAndNeither) {
  const std::string output = (folder_ / "results").string();
  EXPECT_NE(run({"--output", output}).find("either bags or --simulation"), std::string::npos);
  EXPECT_NE(run({"a.bag", "--simulation", "x.yaml", "--output", output}).find("either bags"),
            std::string::npos);
}

TEST_F(StudyTool, RefusesAPlanThatItDoesNotUnderstandBeforeItReadsBags) {
  std::ofstream(folder_ / "plan.yaml") << "study: x\nsectoins: 5\n";
  const std::string text = run({"missing.bag", "--plan", (folder_ / "plan.yaml").string(), "--output",
                                (folder_ / "results").string()});
  EXPECT_NE(text.find("sectoins"), std::string::npos) << text;
}

// Two shards of one study, which the tests copy and damage.
class StudyShards : public StudyTool {
 protected:
  static void SetUpTestSuite() {
    shards_ = fs::path(testing::TempDir()) / ("study_shards_" + std::to_string(::getpid()));
  }
  static void TearDownTestSuite() { fs::remove_all(shards_); }

  void SetUp() override {
    StudyTool::SetUp();
    bag_ = record();
    if (!fs::exists(shards_)) {
      for (const std::string which : {"1/2", "2/2"}) shard(which, {"--output", shards_.string()});
    }
    fs::copy(shards_, folder_ / "out");
  }

  std::string shard(const std::string& which, std::vector<std::string> more) {
    more.insert(more.begin(), {bag_, "--plan", (folder_ / "plan.yaml").string(), "--shard", which});
    return run(more);
  }
  std::string path(const std::string& name) const { return (folder_ / "out" / name).string(); }
  std::string merge() { return run({"--merge", "--no-figures", "--output", (folder_ / "out").string()}); }

  void edit(const std::string& name, const std::string& from, const std::string& to) const {
    std::string content = test_support::contentOf(path(name));
    ASSERT_NE(content.find(from), std::string::npos) << content;
    content.replace(content.find(from), from.size(), to);
    std::ofstream(path(name)) << content;
  }
  void expectRefused(const std::vector<std::string>& parts) {
    const std::string text = merge();
    for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_FALSE(fs::exists(path("results.json")));
  }

  static fs::path shards_;
  std::string bag_;
};
fs::path StudyShards::shards_;

std::string withoutDate(std::string content) {
  const std::size_t date = content.find("\"date\": ");
  return date == std::string::npos ? content : content.erase(date, content.find('\n', date) - date);
}

TEST_F(StudyShards, MakeTheFilesOfARunWithoutShards) {
  const std::string plan = (folder_ / "plan.yaml").string(), whole = (folder_ / "whole").string();
  const std::string text = run({bag_, "--plan", plan, "--no-figures", "--output", whole});
  // The order in which the shards are named does not matter.
  const std::string merged = run({"--merge", path("shard_2_of_2.json"), path("shard_1_of_2.json"),
                                  "--no-figures", "--output", (folder_ / "merged").string()});
  EXPECT_EQ(merged.substr(0, merged.rfind("Results written")), text.substr(0, text.rfind("Results written")));
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(whole)) {
    if (!entry.is_regular_file()) continue;
    const fs::path other = folder_ / "merged" / entry.path().lexically_relative(whole);
    EXPECT_TRUE(withoutDate(test_support::contentOf(entry.path())) ==
                withoutDate(test_support::contentOf(other)))
        << other;
    ++files;
  }
  EXPECT_EQ(files, 11u);
  const std::string pieces = test_support::contentOf(path("pieces_1_of_2.json"));
  const std::size_t date = pieces.find("\"date\":\"") + 8;
  EXPECT_NE(test_support::contentOf(folder_ / "merged" / "results.json").find(pieces.substr(date, 20)),
            std::string::npos)
      << "the date is that of the first shard";
}

TEST_F(StudyShards, AreRefusedIfTheyReadOtherBags) {
  record(61);
  shard("2/2", {"--output", (folder_ / "out").string()});
  expectRefused(
      {"shard_2_of_2.json: recording 1 is session.bag (SHA-256 ", "here and session.bag (SHA-256 "});
}

// The file of the second shard names the pieces of the first.
TEST_F(StudyShards, AreRefusedIfAShardHasThePiecesOfAnother) {
  const auto sumIn = [&](const std::string& name) {
    const std::string content = test_support::contentOf(path(name));
    return content.substr(content.find("_of_2.json\": \"") + 14, 64);
  };
  edit("shard_2_of_2.json", sumIn("shard_2_of_2.json"), sumIn("shard_1_of_2.json"));
  fs::copy_file(path("pieces_1_of_2.json"), path("pieces_2_of_2.json"), fs::copy_options::overwrite_existing);
  expectRefused({"pieces_2_of_2.json: does not have the pieces of shard 2 of 2; run this shard again"});
}

TEST_F(StudyShards, RefuseWhatIsNoShardAndOptionsThatTheyHaveStored) {
  EXPECT_TRUE(test_support::holds(shard("3/2", {"--output", (folder_ / "new").string()}),
                                  {"--shard", "3/2", "I/N", "<=", "e.g. 2/4"}));
  const std::string output = (folder_ / "new").string();
  EXPECT_EQ(run({"--merge", path("shard_1_of_2.json"), "--seed", "2", "--output", output}),
            "--seed cannot be used with --merge, which takes all settings from the shards");
  EXPECT_NE(run({"--merge", "--output", output}).find("new: holds no shard_I_of_N.json"), std::string::npos);
  EXPECT_TRUE(test_support::holds(run({"--merge", path("none.json"), "--output", output}),
                                  {path("none.json"), "there is no such file"}));
}

}  // namespace
}  // namespace fsr_ros
