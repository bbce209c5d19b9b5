#include "ros/tools/tools.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/programs/sibling_program.h"
#include "session/conductor.h"
#include "session/plan.h"
#include "session/session_files.h"
#include "support/content_of.h"
#include "support/holds.h"
#include "support/source_dir.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;
using fsr::session::StepState;

constexpr char kPlan[] =
    "plan: day\nconditioning: {cycles: 0}\nrepeat_first: false\nsurfaces: [{surface: flat}]\n"
    "program: [{cycles: {peak: 600000, rate: 20000, dwell_peak: 1, dwell_rest: 1, cycles: 2}}]\n";

class DayReportTool : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("day & <" + std::to_string(::getpid()) + "_" + std::string(test->name()) + ">");
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const auto plan = fsr::session::readPlan(fsr::settings::Settings::fromText(kPlan, "day.yaml"),
                                             test_support::sourceDir() + "/config/surfaces");
    std::ofstream(path("day_plan.yaml")) << planText(plan);
    fsr::session::ConductorState state = fsr::session::Conductor(plan).state();
    state.steps[0] = StepState::kAccepted;
    state.steps[1] = StepState::kSkipped;
    fsr::session::writeState(path("day_session.yaml"), state);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Returns the exit status, or -1 after an InputError; the output or the message is in said_.
  int run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(dayReportTool, "day_report", words);
    said_ = run.said();
    return run.status;
  }
  std::string page() const { return test_support::contentOf(path("day_report.html")); }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  fs::path folder_;
  std::string said_;
};

TEST_F(DayReportTool, ASessionWithoutBagsHasAReportThatSaysSo) {
  EXPECT_EQ(run({folder_.string()}), 1) << said_;
  EXPECT_TRUE(has(said_, "train gave no result: no bag of this session is in ")) << said_;
  const std::string html = page();
  EXPECT_TRUE(has(html, "train gave no result: no bag")) << html;
  EXPECT_TRUE(has(html, "1 skipped"));
  EXPECT_TRUE(has(html, "day &amp; &lt;" + std::to_string(::getpid()) + "_ASession"))
      << "the name of the folder is escaped";
  EXPECT_FALSE(has(html, "<ASession"));
}

TEST_F(DayReportTool, ABagThatNoToolReadsAppearsWithTheirSentences) {
  std::ofstream(path("day_01_flat.bag")) << "no bag";
  EXPECT_EQ(run({folder_.string()}), 1) << said_;
  for (const char* const tool : {"check_bag", "train", "discrepancy"}) {
    const std::string begin = std::string(tool) + " gave no result: " + tool + ": day_01_flat.bag";
    EXPECT_TRUE(has(said_, begin)) << said_;
    EXPECT_TRUE(has(page(), begin)) << tool;
  }
  EXPECT_TRUE(has(page(), "rosrun fsr_pressure_map train day_01_flat.bag --output day_calibration.h5"));
}

// As a kill -9 or a power cut leaves them.
TEST_F(DayReportTool, BagsThatWereNotClosedAreClosedAndCounted) {
  {
    rosbag::Bag bag(path("day_01_flat.bag.active"), rosbag::bagmode::Write);
    bag.setChunkThreshold(1024);
    for (unsigned i = 0; i < 100; ++i) {
      std_msgs::String message;
      message.data = "message " + std::to_string(100 + i);
      bag.write("/fsr/text", ros::Time(1 + i), message);
    }
  }
  fs::resize_file(path("day_01_flat.bag.active"), fs::file_size(path("day_01_flat.bag.active")) / 2);
  std::ofstream(path("day_01_flat_part2.bag.active")) << "no bag";
  EXPECT_EQ(run({folder_.string()}), 1);
  EXPECT_TRUE(fs::exists(path("day_01_flat.bag")));
  EXPECT_FALSE(fs::exists(path("day_01_flat.bag.active")));
  const std::string closed =
      "day_01_flat.bag.active had not been closed, e.g. because the power went; it is "
      "day_01_flat.bag now and holds ";
  EXPECT_TRUE(has(said_, closed)) << said_;
  EXPECT_TRUE(has(page(), closed));
  EXPECT_TRUE(has(page(), "<td>day_01_flat.bag</td>")) << "it counts as a bag of its mount";
  EXPECT_TRUE(has(said_, "left out: " + path("day_01_flat_part2.bag.active"))) << said_;
  EXPECT_TRUE(has(page(), "Not in this report: ")) << page();
}

TEST_F(DayReportTool, ResultsOfAnEarlierRunAreNotShown) {
  std::ofstream(path("day_01_flat.bag")) << "no bag";
  fs::create_directories(folder_ / "day_report");
  std::ofstream(path("day_report/training.json")) << "{\"id\": \"of_yesterday\"}";
  EXPECT_EQ(run({folder_.string()}), 1);
  EXPECT_FALSE(has(page(), "of_yesterday"));
}

TEST_F(DayReportTool, RefusesAFolderWithoutASessionOrWithoutItsPlan) {
  fs::remove(path("day_plan.yaml"));
  EXPECT_EQ(run({folder_.string()}), -1);
  EXPECT_TRUE(has(said_, "day_plan.yaml: is missing, so that the steps of the session are not known"))
      << said_;
  fs::remove(path("day_session.yaml"));
  EXPECT_EQ(run({folder_.string()}), -1);
  EXPECT_TRUE(has(said_, "has no *_session.yaml, which session.launch writes")) << said_;
  EXPECT_EQ(run({}), -1);
  EXPECT_TRUE(test_support::holds(said_, {"DIR", "day_report --help"}));
}

TEST_F(DayReportTool, RefusesAnotherPlan) {
  std::ofstream(path("other.yaml")) << kPlan << "change: 10\n";
  EXPECT_EQ(run({folder_.string(), "--plan", path("other.yaml"), "--surfaces",
                 test_support::sourceDir() + "/config/surfaces"}),
            -1);
  EXPECT_TRUE(has(said_, "which differs from")) << said_;
}

TEST(SiblingProgram, SaysHowAProgramEnded) {
  const fs::path folder = fs::path(testing::TempDir()) / ("sibling_program_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const ProgramFiles files{folder.string(), (folder / "out").string(), (folder / "err").string()};
  const auto end = [&](const std::string& script) {
    auto program = startProgram("/bin/sh", {"-c", script}, files);
    program.wait();
    return whyItFailed(program, files.errors);
  };
  EXPECT_EQ(end("exit 0"), "");
  EXPECT_EQ(end("exit 4"), "exit status 4");
  EXPECT_EQ(end("echo first >&2; echo train: the reason >&2; exit 2"), "train: the reason");
  EXPECT_EQ(end("kill -9 $$"), "it was ended by signal 9");
  EXPECT_THROW(siblingProgram("no_such_program"), fsr::settings::InputError);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace fsr_ros
