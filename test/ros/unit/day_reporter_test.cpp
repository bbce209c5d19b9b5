#include "ros/recording/day_reporter.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "session/conductor.h"
#include "session/plan.h"
#include "session/session_files.h"
#include "support/folder_test.h"
#include "support/source_dir.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

constexpr char kWriting[] = "The report of the day is being written.";

class DayReporterTest : public test_support::FolderTest {
 protected:
  // A session without bags, so that the report is quickly written.
  void session() const {
    const auto plan = fsr::session::readPlan(
        fsr::settings::Settings::fromText(
            "plan: day\nsurfaces: [{surface: flat}]\nprogram: [{cycles: {peak: 600000, cycles: 2}}]\n",
            "day.yaml"),
        test_support::sourceDir() + "/config/surfaces");
    std::ofstream(folder_ / "day_plan.yaml") << planText(plan);
    fsr::session::writeState((folder_ / "day_session.yaml").string(), fsr::session::Conductor(plan).state());
  }
  std::string report() const { return (folder_ / "day_report.html").string(); }

  static void end(DayReporter& reporter) {
    do {
      reporter.follow(true);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    } while (reporter.sentence() == kWriting);
  }
};

TEST_F(DayReporterTest, WritesTheReportOnceTheSessionIsOver) {
  session();
  DayReporter reporter(folder_.string(), "day");
  reporter.follow(false);
  EXPECT_EQ(reporter.sentence(), "");
  EXPECT_FALSE(fs::exists(report()));
  reporter.follow(true);
  EXPECT_EQ(reporter.sentence(), kWriting);
  end(reporter);
  EXPECT_EQ(reporter.sentence(), "The report of the day is " + report());
  EXPECT_TRUE(fs::exists(report()));
}

TEST_F(DayReporterTest, WritesItAfterARestartOnlyWhereItIsMissing) {
  session();
  std::ofstream(report()) << "of before";
  DayReporter first(folder_.string(), "day");
  first.follow(true);
  EXPECT_EQ(first.sentence(), "The report of the day is " + report());
  EXPECT_EQ(fs::file_size(report()), 9u);
  fs::remove(report());
  DayReporter second(folder_.string(), "day");
  second.follow(true);
  EXPECT_EQ(second.sentence(), kWriting);
  end(second);
  EXPECT_TRUE(fs::exists(report()));
}

TEST_F(DayReporterTest, AStepThatIsTakenBackEndsTheWritingAndTheNextEndWritesAnew) {
  session();
  std::ofstream(report()) << "of before";
  DayReporter reporter(folder_.string(), "day");
  reporter.follow(false);
  reporter.follow(true);
  EXPECT_FALSE(fs::exists(report()) && fs::file_size(report()) == 9u) << "the earlier report must not stay";
  reporter.follow(false);
  EXPECT_EQ(reporter.sentence(), "");
  end(reporter);
  EXPECT_TRUE(fs::exists(report()));
}

TEST_F(DayReporterTest, SaysWhyThereIsNoReport) {
  DayReporter reporter(folder_.string(), "day");
  end(reporter);
  EXPECT_EQ(reporter.sentence().rfind("The report of the day could not be written: day_report: ", 0), 0u)
      << reporter.sentence();
  EXPECT_NE(reporter.sentence().find("has no *_session.yaml"), std::string::npos) << reporter.sentence();
}

}  // namespace
}  // namespace fsr_ros
