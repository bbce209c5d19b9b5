#include "ros/tools/tools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_writer.h"
#include "ros/tools/map_gain.h"
#include "support/content_of.h"
#include "support/example_discrepancy.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/memory_rig.h"
#include "support/mounted_day.h"
#include "support/squeezed.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class TrainTool : public test_support::FolderTest {
 protected:
  void SetUp() override { bend_ = record("bend.bag", {"cylinder_7cm", 14.25}); }

  std::string record(const std::string& name, const test_support::SyntheticSurface& surface) const {
    test_support::SyntheticRig rig;
    rig.surfaces = {surface};
    fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = 1500000000000000000;
    const std::string path = (folder_ / name).string();
    writeBag(path, recording);
    return path;
  }

  std::string run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(trainTool, "train", words);
    EXPECT_EQ(run.status, run.error.empty() ? 0 : -1);
    return run.said();
  }

  std::string bend_;
};

TEST_F(TrainTool, TheFirstWarningNamesTheMountsThatDifferFromTheOthersOfTheirSurface) {
  for (const bool wrong : {true, false}) {
    std::vector<std::string> words;
    for (const fsr::dataset::Recording& mount : test_support::recorded({"bench", 2, wrong})) {
      words.push_back((folder_ / (wrong ? "wrong_" + mount.name : mount.name)).string());
      writeBag(words.back(), mount);
    }
    const std::string output = (folder_ / (wrong ? "wrong.h5" : "clean.h5")).string();
    words.insert(words.end(), {"--output", output, "--history", "none"});
    const std::string text = run(words);
    const std::size_t warning = text.find("Warning: ");
    const std::string names = "Warning: cylinder_10cm: mount 1 (wrong_1_cylinder_10cm.bag) and mount 5 ";
    EXPECT_EQ(warning != std::string::npos && text.compare(warning, names.size(), names) == 0, wrong) << text;
    EXPECT_EQ(text.find("mounts of one surface usually") != std::string::npos, wrong) << text;
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 30) << text;
    const std::vector<std::string> kept = fsr::calibration::loadCalibration(output).warnings;
    EXPECT_EQ(!kept.empty() && ("Warning: " + kept[0]).find(names) == 0, wrong) << "in the file";
  }
}

TEST_F(TrainTool, PrintsCoverageThenScoresThenThePath) {
  const std::string flat = record("flat.bag", {"flat", 0.0});
  const std::string output = (folder_ / "calibration.h5").string();
  const std::string text = run({flat, bend_, "--output", output, "--details"});
  const fsr::calibration::Calibration calibration = fsr::calibration::loadCalibration(output);
  const std::size_t coverage = text.find("Coverage"), scores = text.find("Held-out readings");
  const std::size_t path = text.find("Calibration " + calibration.id + " (interpolated, grnn, bandwidth ");
  EXPECT_LT(coverage, scores);
  EXPECT_LT(scores, path);
  EXPECT_NE(path, std::string::npos) << text;
  EXPECT_NE(text.find(" (chosen)) written to " + output + "\n", path), std::string::npos) << text;
  EXPECT_EQ(calibration.tables.classes.size(), 2u);
  EXPECT_EQ(calibration.provenance.bags.at(1).name, "bend.bag");
  ASSERT_EQ(calibration.provenance.conditioning.size(), 1u);
  EXPECT_EQ(calibration.provenance.conditioning[0].find("conditioning: not seen"), 0u);
  EXPECT_NE(text.find("Note: " + calibration.provenance.conditioning[0] + "\n"), std::string::npos) << text;
  const std::string check = run({"--check", output, flat});
  EXPECT_NE(check.find("Trained with conditioning: not seen"), std::string::npos) << check;
}

TEST_F(TrainTool, TakesItsOptions) {
  const std::string output = (folder_ / "calibration.h5").string();
  const std::string report = (folder_ / "report.json").string();
  const std::string text = run({bend_, "--output=" + output, "--scheme", "baseline", "--ambient", "100000",
                                "--bandwidth", "0.05", "--folds", "4", "--seed", "7", "--threads", "1",
                                "--no-scores", "--namespace", "fsr", "--report", report});
  const fsr::calibration::Calibration calibration = fsr::calibration::loadCalibration(output);
  EXPECT_EQ(calibration.tables.scheme, fsr::compensation::Scheme::kBaseline);
  EXPECT_EQ(calibration.regressor.grnn.bandwidth, 0.05);
  EXPECT_FALSE(calibration.bandwidth_chosen);
  EXPECT_EQ(calibration.folds, 4u);
  EXPECT_EQ(calibration.provenance.seed, 7u);
  EXPECT_NEAR(calibration.trained.pressure.low, 1325.0, 1e-6);  // the bag's ambient is 101325
  EXPECT_TRUE(calibration.scores.conditions.empty());
  EXPECT_NE(text.find("Good for: not known, because scores were not computed"), std::string::npos);
  EXPECT_TRUE(fs::exists(report));
  EXPECT_NE(text.find("Report written to " + report + "\n"), std::string::npos);
}

TEST_F(TrainTool, FitsOnAScreenAndEndsWithWhatTheMapIsGoodFor) {
  const std::string flat = record("flat.bag", {"flat", 0.0});
  const std::string output = (folder_ / "calibration.h5").string();
  const std::string report = (folder_ / "report.json").string();
  const std::string text = run({flat, bend_, "--output", output, "--report", report});
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 30) << text;
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  EXPECT_EQ(
      text.find("Good for: not known on a new mount, because no surface was mounted more than once; 95 % "),
      last)
      << text;
  EXPECT_NE(text.find("\ncylinder_7cm "), std::string::npos) << text;
  EXPECT_EQ(text.find("Error budget [kPa]"), std::string::npos) << text;
  const std::string json = test_support::contentOf(report);
  EXPECT_NE(json.find("\"good_for\": \"Good for: not known on a new mount"), std::string::npos);
  const std::string checked = run({"--check", output, flat, bend_});
  EXPECT_TRUE(test_support::holds(
      checked, {"\nGood for: 68 % of the readings of these bags err by at most ", "; worst bag: "}));
}

TEST_F(TrainTool, TrainsEverySchemeByItsName) {
  const std::string flat = record("flat.bag", {"flat", 0.0});
  const std::string output = (folder_ / "calibration.h5").string();
  for (const std::string& scheme : fsr::compensation::schemeNames()) {
    const std::string text = run({flat, bend_, "--scheme", scheme, "--bandwidth", "0.1", "--output", output});
    EXPECT_TRUE(test_support::holds(text, {" (" + scheme + ", grnn, bandwidth 0.1) written to " + output}));
    EXPECT_EQ(fsr::compensation::schemeName(fsr::calibration::loadCalibration(output).tables.scheme), scheme);
  }
}

TEST_F(TrainTool, TrainsEachModelWithItsOptions) {
  const auto trained = [&](std::vector<std::string> words) {
    const std::string output = (folder_ / "calibration.h5").string();
    words.insert(words.end(), {bend_, "--output", output});
    const std::string text = run(words);
    EXPECT_NE(text.find("written to " + output), std::string::npos) << text;
    return fsr::calibration::loadCalibration(output);
  };
  EXPECT_EQ(trained({"--model", "linear"}).regressor.name, "linear");
  EXPECT_EQ(trained({"--model", "monotone"}).regressor.name, "monotone");
  const fsr::calibration::Calibration forest =
      trained({"--model", "forest", "--trees", "20", "--minimum-leaf", "9", "--leaf-rule", "distinct"});
  EXPECT_EQ(forest.regressor.forest.trees, 20u);
  EXPECT_EQ(forest.regressor.forest.minimum_leaf, 9u);
  EXPECT_EQ(forest.regressor.forest.leaf_count, fsr::regression::LeafCount::kDistinct);
  const fsr::calibration::Calibration grnn =
      trained({"--bandwidth", "auto", "--spread", "matlab", "--equal-bins"});
  EXPECT_EQ(grnn.regressor.grnn.spread, fsr::regression::SpreadMeaning::kHalf);
  EXPECT_EQ(grnn.regressor.grnn.weighting, fsr::regression::SampleWeighting::kEachPressureBin);
  EXPECT_TRUE(grnn.bandwidth_chosen);
  EXPECT_EQ(trained({"--distance=literal"}).regressor.grnn.distance,
            fsr::regression::KernelDistance::kLiteral);
}

// A sheet that reads 0.4 % a kelvin more in a room that warms and cools.
TEST_F(TrainTool, TakesTheTemperatureOut) {
  test_support::MemoryRig rig;
  rig.program = test_support::variedProgram();
  fsr::dataset::Recording recording = test_support::memoryRecording(rig);
  recording.start_ns = 1500000000000000000;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const double temperature = 25 + 4 * std::sin(recording.time[i] / 40);
    recording.temperature.push_back(temperature);
    for (std::size_t taxel = 0; taxel < 3; ++taxel) {
      std::uint16_t& count = recording.counts[3 * i + taxel];
      count = std::uint16_t(std::lround(count * (1 + 0.004 * (temperature - 25))));
    }
  }
  const std::string bag = (folder_ / "warm.bag").string(), output = (folder_ / "c.h5").string();
  writeBag(bag, recording);
  const std::string text = run({bag, "--output", output, "--details"});
  EXPECT_TRUE(test_support::holds(
      text, {"Temperature: -0.4", " % a kelvin with a lag of 0 s; it wins", "without temperature"}));
  EXPECT_TRUE(fsr::calibration::loadCalibration(output).temperature.present());
  const std::string checked = run({"--check", output, bag});
  EXPECT_NE(checked.find("Still good."), std::string::npos) << checked;
  for (const auto& words : {std::vector<std::string>{"--temperature", "none"}, {"--history", "none"}}) {
    std::vector<std::string> all = {bag, "--output", output};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(run(all).find("Temperature:"), std::string::npos);
    EXPECT_FALSE(fsr::calibration::loadCalibration(output).temperature.present());
  }
  run({bag, "--output", output, "--history", "none", "--temperature", "auto"});
  EXPECT_TRUE(fsr::calibration::loadCalibration(output).temperature.present());
  EXPECT_TRUE(test_support::holds(run({bag, "--output", output, "--temperature", "warm"}),
                                  {"must be one of auto, none"}));
}

// A sheet with a loop, recorded with two paces, dwells and peaks.
TEST_F(TrainTool, TakesTheSheetsMemoryOut) {
  test_support::MemoryRig rig;
  rig.program = test_support::variedProgram();
  rig.loop = 0.08;
  fsr::dataset::Recording recording = test_support::memoryRecording(rig);
  recording.start_ns = 1500000000000000000;
  const std::string bag = (folder_ / "memory.bag").string(), output = (folder_ / "c.h5").string();
  const std::string verdict = (folder_ / "verdict.yaml").string();
  writeBag(bag, recording);
  const auto chosen = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all = {bag, "--output", output, "--details"};
    all.insert(all.end(), words.begin(), words.end());
    const std::string text = run(all);
    return text.substr(std::min(text.size(), text.find("History: ")));
  };
  const std::string automatic = chosen({});
  EXPECT_EQ(automatic.find("History: "), 0u) << automatic;
  EXPECT_TRUE(test_support::holds(automatic, {"on protocols that were left out.", "unloading"}));
  EXPECT_TRUE(fsr::calibration::loadCalibration(output).history.present());
  EXPECT_EQ(chosen({"--history", "memories"}).find("History: memories, as asked for"), 0u);
  EXPECT_EQ(chosen({"--history", "none"}), "");
  EXPECT_FALSE(fsr::calibration::loadCalibration(output).history.present());
  EXPECT_TRUE(test_support::holds(run({bag, "--output", output, "--history", "loop"}),
                                  {"--history is \"loop\", but must be auto"}));
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--history", "plays"}),
                                  {"record cycles with two paces"}));

  fsr::discrepancy::DiscrepancyReport report = test_support::exampleDiscrepancy();
  std::ofstream(verdict) << fsr::report::verdictText(report);
  const std::string proposed = chosen({"--history", verdict});
  EXPECT_TRUE(test_support::holds(proposed, {"as proposed; the error falls by "}));
}

// Sheets with an offset of each taxel that changes from session to session.
TEST_F(TrainTool, ExpectsATareAtTheStartOfASession) {
  std::vector<std::string> words;
  for (std::size_t number = 1; number <= 4; ++number) {
    fsr::dataset::Recording recording = test_support::memorySession(number, 10e3);
    recording.start_ns = 1500000000000000000;
    words.push_back((folder_ / recording.name).string());
    writeBag(words.back(), recording);
  }
  const std::string fresh = words.back(), output = (folder_ / "c.h5").string();
  const std::string report = (folder_ / "report.json").string();
  words.back() = "--history=none";
  words.insert(words.end(), {"--output", output, "--report", report, "--details"});
  const std::string text = run(words);
  EXPECT_TRUE(test_support::holds(text, {"Tare at the start of a session: expected, since it takes ",
                                         "\nsession_3.bag, flat, mount 1 "}));
  const std::string json = test_support::contentOf(report);
  EXPECT_NE(json.find("\"tare_expected\": true"), std::string::npos);
  EXPECT_TRUE(test_support::holds(run({"--check", output, fresh}),
                                  {"Note: each session is checked with a tare at its start"}));
  words.insert(words.end(), {"--zero", "none"});
  EXPECT_EQ(run(words).find("Tare at the start"), std::string::npos);
  EXPECT_FALSE(fsr::calibration::loadCalibration(output).session_zero.expected());
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--zero", "yes"}), {"--zero", "\"yes\""}));
  EXPECT_EQ(
      run({bend_, "--output", output, "--zero", "session"}).find("zero session: no session can be tared"),
      0u);
}

// What discrepancy says of its verdict, from the same training.
TEST(MapGain, IsThatOfTrainingWithAndWithout) {
  test_support::MemoryRig rig;
  rig.program = test_support::variedProgram();
  rig.loop = 0.08;
  const std::string gain = mapGain({test_support::memoryRecording(rig)}, {"hysteresis"}, 1);
  EXPECT_EQ(gain.find("On protocols that were left out, the error of the map falls from "), 0u) << gain;
  fsr::dataset::Recording sixteen_bits = test_support::memoryRecording(rig);
  const int factor = 65535 / sixteen_bits.full_scale;
  for (std::uint16_t& count : sixteen_bits.counts) count = static_cast<std::uint16_t>(factor * count);
  sixteen_bits.full_scale = 65535;
  EXPECT_EQ(mapGain({sixteen_bits}, {"hysteresis"}, 1), gain);
  rig.loop = 0;
  EXPECT_EQ(mapGain({test_support::memoryRecording(rig)}, {"hysteresis"}, 1).find("Nothing. On protocols"),
            0u);
  EXPECT_EQ(mapGain({test_support::memoryRecording(rig)}, {"wear"}, 1).find("Nothing from this name"), 0u);
  rig.program = {{6, 600e3, 20e3, 2, 2}};
  EXPECT_EQ(
      mapGain({test_support::memoryRecording(rig)}, {"creep"}, 1).find("Not known. History: none, since all"),
      0u);
  EXPECT_EQ(mapGain({}, {}, 1), "");
}

TEST_F(TrainTool, MergesCalibrations) {
  const std::string flat = record("flat.bag", {"flat", 0.0});
  const std::string a = (folder_ / "a.h5").string(), b = (folder_ / "b.h5").string();
  const std::string merged = (folder_ / "merged.h5").string(), whole = (folder_ / "whole.h5").string();
  run({flat, "--output", a});
  run({bend_, "--output", b});
  run({flat, bend_, "--output", whole});
  const std::string text = run({"--merge", a, b, "--output", merged, "--threads", "1"});
  EXPECT_TRUE(test_support::holds(text, {"A merged calibration has no scores", " written to " + merged}));
  const fsr::compensation::CurvatureTables one = fsr::calibration::loadCalibration(merged).tables;
  const fsr::compensation::CurvatureTables other = fsr::calibration::loadCalibration(whole).tables;
  ASSERT_EQ(one.tables.size(), other.tables.size());
  for (std::size_t i = 0; i < one.tables.size(); ++i) {
    EXPECT_EQ(one.tables[i].pressure, other.tables[i].pressure);
    EXPECT_EQ(one.tables[i].deviation, other.tables[i].deviation);
  }
  EXPECT_EQ(run({"--merge", a, "--output", merged}), "merging needs two calibration files or more");
  EXPECT_TRUE(test_support::holds(run({"--merge", a, b, "--output", merged, "--model", "linear"}),
                                  {"--model", "--merge"}));
  EXPECT_TRUE(test_support::holds(run({"--merge", a, a, "--output", merged}),
                                  {a, "flat.bag", "was trained on flat.bag"}));
}

TEST_F(TrainTool, AFailureOverwritesNothing) {
  const std::string output = (folder_ / "calibration.h5").string();
  const std::string old = "fsr_pressure_map calibration schema=8\n";
  std::ofstream(output) << old;
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--scheme", "flat_only"}),
                                  {"scheme is flat_only", "(there is cylinder_7cm)", "per_curvature"}));
  EXPECT_EQ(test_support::contentOf(output), old);
}

TEST_F(TrainTool, PrintsTheErrorBudgetOfAFileAgain) {
  const std::string output = (folder_ / "calibration.h5").string();
  const std::string trained = run({bend_, "--output", output, "--transducer", "1500", "--details"});
  const std::string again = run({"--budget", output});
  const std::size_t start = again.find("Error budget [kPa]");
  EXPECT_NE(again.find("sheet was not conditioned"), std::string::npos) << again;
  ASSERT_NE(start, std::string::npos) << again;
  EXPECT_NE(trained.find(again.substr(start)), std::string::npos) << trained;
  EXPECT_NE(test_support::squeezed(again).find("transducer of the chamber 1.50 1.50 1.50 declared"),
            std::string::npos)
      << again;
  const std::string clinic = run({"--budget", output, "--unit", "mmHg"});
  EXPECT_NE(clinic.find("Error budget [mmHg]"), std::string::npos) << clinic;
  EXPECT_EQ(clinic.find("[kPa]"), std::string::npos) << clinic;
  EXPECT_NE(test_support::squeezed(clinic).find("transducer of the chamber 11.25 11.25 11.25 declared"),
            std::string::npos)
      << clinic;
  EXPECT_EQ(run({"--budget", output}), again);
  EXPECT_TRUE(test_support::holds(run({"--budget", output, bend_}), {"--budget", "--output"}));
  EXPECT_NE(run({bend_, "--output", output, "--transducer", "-1"}).find("--transducer"), std::string::npos);
}

// For one version.
TEST_F(TrainTool, HandsTheOldOptionsOverToCheckCalibration) {
  const std::string output = (folder_ / "calibration.h5").string();
  run({bend_, "--output", output, "--no-scores", "--bandwidth", "0.05"});
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--check", output, bend_}, {bend_, "--check=" + output}}) {
    const std::string said = run(words);
    EXPECT_EQ(said.find("train --check is now check_calibration: " + output + ' ' + bend_ + '\n'), 0u)
        << said;
    EXPECT_NE(said.find("Still good."), std::string::npos) << said;
  }
  const std::string corrected = run({"--correct", output, bend_, "--same-mount"});
  EXPECT_NE(corrected.find("\nStill good: "), std::string::npos) << corrected;
}

TEST_F(TrainTool, WrongUsageIsOneSentence) {
  const std::string output = (folder_ / "calibration.h5").string();
  EXPECT_TRUE(test_support::holds(run({bend_}), {"--output FILE", "--help"}));
  EXPECT_TRUE(test_support::holds(run({"--output", output}), {"there is no recording to train on"}));
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--scheme", "best"}),
                                  {"--scheme", "\"best\"", "flat_only", "per_curvature", "per_surface"}));
  EXPECT_TRUE(
      test_support::holds(run({bend_, "--output", output, "--model", "best"}), {"--model", "\"best\""}));
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--trees", "5"}), {"--trees", "--model"}));
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--bandwidth", "wide"}),
                                  {"bandwidth is \"wide\""}));
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", output, "--leaf-rule", "few", "--model", "forest"}),
                                  {"--leaf-rule", "\"few\""}));
  EXPECT_TRUE(
      test_support::holds(run({bend_, "--output", output, "--folds", "1"}), {"--folds", "\"1\"", "2 to 20"}));
  EXPECT_TRUE(test_support::holds(run({bend_, "--output", "/no/such/place.h5"}),
                                  {"/no/such/place.h5", "cannot be written"}));
  EXPECT_TRUE(test_support::holds(run({bend_, bend_, "--output", output}),
                                  {"bend.bag", "has the same bytes as bend.bag"}));
  EXPECT_EQ(run({"--help"}).rfind("train BAG... --output FILE, or --merge", 0), 0u);
}

}  // namespace
}  // namespace fsr_ros
