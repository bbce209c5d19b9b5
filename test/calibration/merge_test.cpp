#include "calibration/merge.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

using test_support::syntheticRecording;
using test_support::SyntheticRig;

// Bags that differ in everything that merging must combine.
dataset::Recording bag(const std::string& name, unsigned seed,
                       const std::vector<test_support::SyntheticSurface>& surfaces, double peak = 600e3) {
  SyntheticRig rig;
  rig.name = name;
  rig.seed = seed;
  rig.surfaces = surfaces;
  rig.peak = peak;
  rig.cycles = 7 + seed;
  dataset::Recording recording = syntheticRecording(rig);
  recording.sha256 = std::string(64, static_cast<char>('0' + seed));
  recording.temperature.assign(recording.scans(), 20.0 + seed);
  recording.warnings = {"a warning"};
  return recording;
}

std::vector<dataset::Recording> threeBags() {
  std::vector<dataset::Recording> bags = {
      bag("a.bag", 1, {{"cylinder_10cm", 10.0}}),
      bag("b.bag", 2, {{"flat", 0.0}, {"cylinder_10cm_again", 10.1}}, 500e3),
      bag("c.bag", 3, {{"cylinder_5cm", 20.0}, {"flat", 0.0}, {"nearly_flat", 0.1}}, 620e3)};
  bags[1].mask = {0, 1, 0, 0, 0, 0};
  for (std::size_t i = 0; i < bags[0].scans(); ++i)
    bags[0].counts[6 * i + 4] = 7;  // constant in one part only
  bags[0].sensor.serial.clear();
  bags[2].sensor.transducer = "gauge 7";
  return bags;
}

struct Setting {
  std::string name;
  compensation::Scheme scheme = compensation::Scheme::kPerCurvature;
  regression::RegressorOptions regressor;
  bool choose_bandwidth = false;
};

Setting setting(const std::string& name, compensation::Scheme scheme, const std::string& model,
                bool choose = false) {
  Setting set{name, scheme, {}, choose};
  set.regressor.name = model;
  return set;
}

Calibration train(const std::vector<dataset::Recording>& recordings, const Setting& set) {
  CalibrationProblem problem{recordings, {}};
  problem.options.scheme = set.scheme;
  problem.options.regressor = set.regressor;
  problem.options.choose_bandwidth = set.choose_bandwidth;
  problem.options.scores = false;
  problem.options.date = "2024-05-06T07:08:09Z";
  problem.options.temperature = false;  // a model of the temperature does not merge
  return calibrate(problem);
}

class Merge : public testing::TestWithParam<Setting> {
 protected:
  std::string path(const std::string& name) const {
    return (std::filesystem::path(testing::TempDir()) /
            ("merge_" + std::to_string(::getpid()) + GetParam().name + name))
        .string();
  }
  // Through files, as in use.
  MergePart part(const std::string& name, const std::vector<dataset::Recording>& recordings) const {
    saveCalibration(train(recordings, GetParam()), path(name));
    return {name, loadCalibration(path(name), CalibrationParts::kAll)};
  }
};

TEST_P(Merge, GivesTheFileOfTrainingOnAllBags) {
  const auto bags = threeBags();
  const MergeOptions options{2, "2024-05-06T07:08:09Z"};
  const Calibration merged =
      mergeCalibrations({part("ab.h5", {bags[0], bags[1]}), part("c.h5", {bags[2]})}, options);
  Calibration at_once = train(bags, GetParam());
  EXPECT_EQ(merged.shape.missing.find("a merged calibration"), 0u);
  at_once.shape = merged.shape;  // the model of the shape needs the bags
  // A part knows the peaks of its own bags only, and says for each session what conditioning would have been.
  at_once.provenance.conditioning = merged.provenance.conditioning;
  EXPECT_EQ(merged.warnings, at_once.warnings);
  EXPECT_EQ(merged.regressor.grnn.bandwidth, at_once.regressor.grnn.bandwidth);
  // The id is the hash of the content of the file.
  EXPECT_EQ(saveCalibration(merged, path("merged.h5")), saveCalibration(at_once, path("at_once.h5")));
}

TEST_P(Merge, OfMergedFilesGivesTheSameFile) {
  const auto bags = threeBags();
  const MergeOptions options{1, "2024-05-06T07:08:09Z"};
  const MergePart a = part("a.h5", {bags[0]}), b = part("b.h5", {bags[1]}), c = part("c.h5", {bags[2]});
  const Calibration in_steps = mergeCalibrations({{"ab", mergeCalibrations({a, b}, options)}, c}, options);
  EXPECT_EQ(saveCalibration(in_steps, path("steps.h5")),
            saveCalibration(mergeCalibrations({a, b, c}, options), path("at_once.h5")));
}

// Shards of bags: whoever trains which, the sums and the pressures are those of training on all bags. The
// deviations are not: the error of another mount needs the readings.
TEST_P(Merge, OfShardsGivesThePressuresOfTrainingOnAllBagsInAnyGrouping) {
  std::vector<dataset::Recording> bags;
  for (unsigned i = 0; i < 6; ++i) {
    bags.push_back(
        bag("bag_" + std::to_string(i), i + 1, {{i % 2 == 0 ? "flat" : "bent", i % 2 == 0 ? 0.0 : 10.0}}));
    bags.back().conditions.front().mount = i + 1;
  }
  const Calibration at_once = train(bags, GetParam());
  const std::vector<std::vector<std::size_t>> groupings[] = {
      {{0, 1, 2}, {3, 4, 5}}, {{0, 1}, {2, 3}, {4, 5}}, {{5, 0}, {1, 2, 3, 4}}};
  for (const auto& grouping : groupings) {
    std::vector<MergePart> parts;
    for (const std::vector<std::size_t>& members : grouping) {
      std::vector<dataset::Recording> own;
      for (const std::size_t member : members) own.push_back(bags[member]);
      parts.push_back(part("shard_" + std::to_string(parts.size()) + ".h5", own));
    }
    const Calibration merged = mergeCalibrations(parts, {2, "2024-05-06T07:08:09Z"});
    EXPECT_TRUE(merged.statistics->cells == at_once.statistics->cells);
    EXPECT_EQ(merged.regressor.grnn.bandwidth, at_once.regressor.grnn.bandwidth);
    ASSERT_EQ(merged.tables.tables.size(), at_once.tables.tables.size());
    for (std::size_t i = 0; i < merged.tables.tables.size(); ++i)
      EXPECT_EQ(merged.tables.tables[i].pressure, at_once.tables.tables[i].pressure);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Merge,
                         testing::Values(setting("grnn", compensation::Scheme::kPerCurvature, "grnn"),
                                         setting("tuned", compensation::Scheme::kPerCurvature, "grnn", true),
                                         setting("baseline", compensation::Scheme::kBaseline, "grnn"),
                                         setting("method_2", compensation::Scheme::kCurvatureInput, "grnn"),
                                         setting("scaled", compensation::Scheme::kScaledCurvature, "grnn"),
                                         setting("ranges", compensation::Scheme::kCurvatureRanges, "grnn",
                                                 true),
                                         setting("by_name", compensation::Scheme::kPerSurface, "grnn"),
                                         setting("linear", compensation::Scheme::kPerCurvature, "linear")),
                         [](const auto& set) { return set.param.name; });

std::string complaint(const std::vector<MergePart>& parts) {
  return test_support::refusal([&] { mergeCalibrations(parts); }, "merged");
}

TEST(MergeRefuses, CalibrationsThatWereTrainedDifferently) {
  const Setting grnn = setting("grnn", compensation::Scheme::kBaseline, "grnn");
  const auto bags = threeBags();
  const MergePart first{"a.h5", train({bags[1]}, grnn)};
  const auto refusal = [&](const Calibration& other) { return complaint({first, {"b.h5", other}}); };
  const std::string rest = "; only calibrations that were trained alike can be merged";

  EXPECT_EQ(refusal(train({bags[2]}, grnn)), "merged");
  EXPECT_EQ(complaint({first}), "merging needs two calibration files or more");
  EXPECT_TRUE(test_support::holds(refusal(train({bags[1]}, grnn)),
                                  {"b.h5", "b.bag", "a.h5", "was trained on b.bag"}));
  SyntheticRig wide;
  wide.size = {3, 3};
  EXPECT_TRUE(test_support::holds(refusal(train({syntheticRecording(wide)}, grnn)),
                                  {"b.h5", "matrix is 3 x 3", "a.h5", "2 x 3", rest}));
  SyntheticRig fine;
  fine.full_scale = 8191;
  EXPECT_TRUE(test_support::holds(refusal(train({syntheticRecording(fine)}, grnn)),
                                  {"b.h5", "full_scale", "8191", "a.h5", rest}));
  EXPECT_TRUE(
      test_support::holds(refusal(train({bags[2]}, setting("", compensation::Scheme::kPerCurvature, "grnn"))),
                          {"b.h5", "scheme is per_curvature", "a.h5", rest}));
  EXPECT_TRUE(
      test_support::holds(refusal(train({bags[2]}, setting("", compensation::Scheme::kBaseline, "linear"))),
                          {"b.h5", "a.h5", rest, "the model is linear"}));
  EXPECT_TRUE(test_support::holds(
      refusal(train({bags[2]}, setting("", compensation::Scheme::kBaseline, "grnn", true))),
      {"b.h5", "a.h5", "0.0078125", rest}));
  Calibration other = train({bags[2]}, grnn);
  other.folds = 4;
  EXPECT_TRUE(test_support::holds(refusal(other), {"b.h5", "sections is 4", "a.h5", rest}));
  other = train({bags[2]}, grnn);
  other.sensor.serial = "0002";
  EXPECT_TRUE(test_support::holds(refusal(other), {"b.h5", "number is \"0002\"", "a.h5", "\"0001\"", rest}));
}

TEST(MergeRefuses, ModelsThatNeedTheBags) {
  const auto bags = threeBags();
  for (const std::string model : {"forest", "monotone"}) {
    const Setting set = setting("", compensation::Scheme::kBaseline, model);
    EXPECT_TRUE(
        test_support::holds(complaint({{"a.h5", train({bags[0]}, set)}, {"c.h5", train({bags[2]}, set)}}),
                            {"a.h5", model, "needs the bags"}));
  }
  const Setting grnn = setting("", compensation::Scheme::kBaseline, "grnn");
  Calibration bare = train({bags[0]}, grnn);
  bare.statistics = nullptr;
  EXPECT_TRUE(test_support::holds(complaint({{"a.h5", bare}, {"c.h5", train({bags[2]}, grnn)}}),
                                  {"a.h5", "holds no statistics to merge"}));
}

TEST(MergeRefuses, CurvaturesThatWouldFormOtherClasses) {
  const Setting grnn = setting("", compensation::Scheme::kPerCurvature, "grnn");
  // 10.2 and 10.4 form one class, but together with 10.0 only 10.2 is near enough.
  const Calibration pair = train({bag("pair.bag", 1, {{"one", 10.2}, {"two", 10.4}})}, grnn);
  const Calibration lower = train({bag("lower.bag", 2, {{"three", 10.0}})}, grnn);
  ASSERT_EQ(pair.tables.classes.size(), 1u);
  EXPECT_TRUE(test_support::holds(
      complaint({{"pair.h5", pair}, {"lower.h5", lower}}),
      {"pair.h5", "its curvatures would form other classes together with those of the others"}));
}

TEST(MergeAccepts, FilesOfSchemaOne) {
  const std::string path = test_support::sourceDir() + "/test/data/calibrations/schema_1.h5";
  const Calibration old = loadCalibration(path, CalibrationParts::kAll);
  Calibration twin = old;
  for (SourceBag& source : twin.provenance.bags) source.sha256.clear();
  const Calibration merged = mergeCalibrations({{"old.h5", old}, {"twin.h5", twin}});
  EXPECT_EQ(merged.tables.classes.size(), old.tables.classes.size());
  EXPECT_EQ(merged.coverage.conditions.at(0).scans, 2 * old.coverage.conditions.at(0).scans);
  for (std::size_t i = 0; i < old.tables.tables.size(); ++i) {
    EXPECT_EQ(merged.tables.tables[i].lowest, old.tables.tables[i].lowest);
  }
}

}  // namespace
}  // namespace fsr::calibration
