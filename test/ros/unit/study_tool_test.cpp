#include "ros/tools/tools.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ros/bags/bag_writer.h"
#include "support/content_of.h"
#include "support/folder_test.h"
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

  std::string record() const {
    test_support::SyntheticRig rig;
    rig.surfaces = {{"flat", 0.0}, {"cylinder_13cm", 7.7}, {"cylinder_5cm", 20.0}};
    rig.scans_per_cycle = 60;
    rig.noise = 60;
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

}  // namespace
}  // namespace fsr_ros
