#include "ros/tools/discrepancy_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "ros/tools/tool_options.h"
#include "support/content_of.h"
#include "support/example_discrepancy.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/source_dir.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class DiscrepancyFiles : public test_support::FolderTest {
 protected:
  void SetUp() override {
    report_.base = report_.added =
        fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/core.yaml");
  }

  std::string text(const std::string& name) const { return test_support::contentOf(folder_ / name); }
  /// Draws the report; returns the error, or "".
  std::string draw() const {
    return test_support::refusal([&] {
      runPython(test_support::sourceDir() + "/scripts/figures/discrepancy.py", {folder_.string()});
    });
  }

  fsr::discrepancy::DiscrepancyReport report_ = test_support::exampleDiscrepancy();
};

TEST_F(DiscrepancyFiles, AreAllThereAndReadBack) {
  writeDiscrepancy(report_, outputFolder(folder_.string()));
  EXPECT_EQ(fsr::report::readVerdict((folder_ / "verdict.yaml").string()).verdict, "named");
  const fsr::simulation::SimulationSettings added =
      fsr::simulation::readSimulationFile((folder_ / "simulation.yaml").string());
  EXPECT_EQ(added.effects.size(), report_.added.effects.size());
  const StoredPrediction stored = readPredictionBeside((folder_ / "verdict.yaml").string());
  EXPECT_EQ(stored.frozen.prediction.hash, report_.prediction.hash);
  EXPECT_EQ(stored.base.effects.size(), report_.base.effects.size());
  EXPECT_NE(text("simulation.yaml").find(report_.inputs[0].sha256), std::string::npos);
}

TEST_F(DiscrepancyFiles, RefuseAVerdictThatWasEditedSince) {
  writeDiscrepancy(report_, outputFolder(folder_.string()));
  std::ofstream(folder_ / "verdict.yaml", std::ios::app) << "# 0.07 looks better\n";
  EXPECT_TRUE(test_support::holds(
      test_support::refusal([&] { readPredictionBeside((folder_ / "verdict.yaml").string()); }), {"edited"}));
}

TEST_F(DiscrepancyFiles, BecomeAReportThatNeedsNoNetwork) {
  writeDiscrepancy(report_, outputFolder(folder_.string()));
  ASSERT_EQ(draw(), "");
  const std::string html = text("report.html");
  for (const char* part :
       {"Best explanation among 3 effects tested", "How sure", "Not excluded: hysteresis",
        "The gain changes from cycle to cycle by 1.2 %", "crosstalk (uneven load)", "Run five cycles",
        "3.10 %", "19.2 kPa", "floor", "data:image/png;base64", "3 times by now"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  for (const char* part : {"http://", "https://", "<script", "src=\"/", "file://"})
    EXPECT_EQ(html.find(part), std::string::npos) << part;
  EXPECT_TRUE(fs::exists(folder_ / "figures" / "disagreement.png"));
}

TEST_F(DiscrepancyFiles, BecomeAReportWithoutControlCharacters) {
  report_.inputs[0].file = "1_\x1B[31mflat\xC2\x9B.bag";
  writeDiscrepancy(report_, outputFolder(folder_.string()));
  ASSERT_EQ(draw(), "");
  const std::string html = text("report.html");
  EXPECT_NE(html.find("1_?[31mflat?.bag"), std::string::npos);
  EXPECT_EQ(html.find("\x1B"), std::string::npos);
}

TEST_F(DiscrepancyFiles, BecomeAReportWhateverIsAbsent) {
  fsr::discrepancy::DiscrepancyReport nothing;
  nothing.sentence = "Nothing is missing.";
  nothing.base = nothing.added = report_.base;
  nothing.gap.closed = NAN;
  nothing.gap.closed_interval = {NAN, NAN};
  writeDiscrepancy(nothing, outputFolder(folder_.string()));
  EXPECT_EQ(draw(), "");
  EXPECT_NE(text("report.html").find("Nothing is missing."), std::string::npos);
}

TEST_F(DiscrepancyFiles, CountEveryUseOfABag) {
  const ShowLedger ledger((folder_ / "ledger").string());
  const std::string bag(64, 'a'), other(64, 'b');
  EXPECT_EQ(ledger.open(bag, 1), 1);
  EXPECT_EQ(ledger.open(bag, 1), 2);
  EXPECT_EQ(ledger.open(other, 1), 1);
  EXPECT_EQ(ShowLedger((folder_ / "ledger").string()).open(bag, 7), 3);
}

TEST_F(DiscrepancyFiles, ReportALedgerThatCannotBeWritten) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "ledger") << "a file, no folder";
  EXPECT_THROW(ShowLedger((folder_ / "ledger").string()).open(std::string(64, 'a'), 1),
               fsr::settings::InputError);
}

}  // namespace
}  // namespace fsr_ros
