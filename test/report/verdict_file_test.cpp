#include "report/verdict_file.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/example_discrepancy.h"
#include "support/holds.h"

namespace fsr::report {
namespace {

namespace fs = std::filesystem;
using test_support::exampleDiscrepancy;

class VerdictOnDisk : public testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::path(testing::TempDir()) /
            ("verdict_" + std::to_string(::getpid()) + "_" +
             std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".yaml");
  }
  void TearDown() override { fs::remove(path_); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  /// The message of the refusal when the example is read with `from` replaced; "" if it is accepted.
  std::string complaint(const std::string& from, const std::string& to) const {
    std::string text = verdictText(exampleDiscrepancy());
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    write(text.replace(at, from.size(), to));
    return test_support::refusal([&] { readVerdict(path_); });
  }
  std::string path_;
};

TEST(VerdictText, IsExactlyAsDocumented) {
  const std::string expected = R"(verdict: named
effects:
  - {id: hysteresis, parameters: [{name: loop_width, value: 0.062, unit: fraction of full scale, interval: [0.058, 0.067]}], evidence: {z: 14.1, share_of_ceiling: 0.93}}
credible_set: [[hysteresis]]
depends_on: [direction, pressure]
p: 0.0033
at_map: 20000
least_gap: 1240
in_use:
  - {situation: ramp, before: 21000, after: 5000}
  - {situation: stance, before: 18000, after: 4000}
  - {situation: standing, before: 9000, after: null}
smallest_seen:
  - {id: hysteresis, at_map: 1300}
  - {id: creep, at_map: 2400}
  - {id: wear, at_map: null}
too_small: []
scatter:
  - {part: cycle_gain, size: 0.012, unit: share, interval: [0.009, 0.016], at_map: 3100}
  - {part: cycle_offset, size: 0, unit: share of full scale, interval: [0, 0.0004], at_map: 0}
  - {part: wandering, size: 0.0011, unit: share of full scale, interval: [0.0008, 0.0014], at_map: 650}
asked:
  - {id: crosstalk, answer: not_identifiable}
not_identifiable:
  - {id: crosstalk, experiment: uneven_load}
  - {id: wear, experiment: many_cycles}
where: {taxels: [0, 3], conditions: [flat, cylinder_7cm], pressure: [50000, 400000], direction: both, time: all}
gap: {before: 0.031, after: 0.008, floor: 0.006, floor_bracket: [0.006, 0.0071], closed: 0.92, closed_interval: [0.9, 0.94], unit: fraction of full scale, held_out_by: [cycles, condition], surfaces: [{surface: flat, before: 0.03, after: 0.007}, {surface: cylinder_7cm, before: 0.032, after: 0.009}], covered: [{surface: flat, pressure: [0, 620000]}, {surface: cylinder_7cm, pressure: [0, 615000]}], left_out: 12}
hold_out:
  - {file: "1_flat.bag", cycles: [[946684875.100000000, 946684950.000000000]]}
  - {file: "2_bent.bag", cycles: [[946685000.000000001, 946685074.900000000], [946685150.000000000, 946685224.900000000]]}
recompute: rosrun fsr_pressure_map simulate --gap found/verdict.yaml --drive 1_flat.bag 2_bent.bag
)";
  const std::string text = verdictText(exampleDiscrepancy());
  const std::size_t begin = text.find("verdict:"), end = text.find("next_experiment:");
  EXPECT_EQ(text.substr(begin, end - begin), expected);
}

// As versions up to 0.2.0 wrote it: one line a list, effects in block style, hashes in quotes.
TEST_F(VerdictOnDisk, ReadsTheLayoutOfEarlierVersions) {
  std::string text = verdictText(exampleDiscrepancy());
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("- {id: hysteresis, parameters", "- id: hysteresis\n    parameters");
  replace(", evidence: {z: 14.1, share_of_ceiling: 0.93}}", "\n    evidence: {z: 14.1}");
  replace("asked:\n  - {id: crosstalk, answer: not_identifiable}", "asked: [{id: crosstalk, answer: none}]");
  write(text);
  EXPECT_EQ(readVerdict(path_).effects, (std::vector<std::string>{"hysteresis"}));
  EXPECT_EQ(readVerdict(path_).gap_after, 0.008);
}

TEST(VerdictText, HasNullForAbsentValues) {
  discrepancy::DiscrepancyReport report;
  report.sentence = "Nothing: \"noise\" alone.";
  report.version = "0.1.0";
  const YAML::Node yaml = YAML::Load(verdictText(report));
  EXPECT_EQ(yaml["verdict"].as<std::string>(), "none");
  EXPECT_TRUE(yaml["where"].IsNull());
  EXPECT_TRUE(yaml["next_experiment"].IsNull());
  EXPECT_TRUE(yaml["gap"]["before"].IsNull());
  EXPECT_TRUE(yaml["gap"]["floor_bracket"].IsNull());
  EXPECT_TRUE(yaml["recompute"].IsNull());
  EXPECT_TRUE(yaml["gap"]["closed"].IsNull());
  EXPECT_TRUE(yaml["gap"]["closed_interval"].IsNull());
  EXPECT_TRUE(yaml["effects"].IsSequence());
  EXPECT_EQ(yaml["effects"].size(), 0u);
  EXPECT_EQ(yaml["hold_out"].size(), 0u);
}

TEST(VerdictText, QuotesNamesThatYamlWouldReadOtherwise) {
  discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  report.where.conditions = {"no", "12", "a, b: \"c\"", "tilde ~"};
  report.inputs[0].file = "{strange}.bag";
  const YAML::Node yaml = YAML::Load(verdictText(report));
  EXPECT_EQ(yaml["where"]["conditions"].as<std::vector<std::string>>(), report.where.conditions);
  EXPECT_EQ(yaml["inputs"][0]["file"].as<std::string>(), "{strange}.bag");
}

TEST(VerdictText, HasNumbersThatEveryYamlReaderReads) {
  discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  report.effects[0].parameters[0].value = 1e-6;
  report.effects[0].parameters[0].interval = {-2.5e-7, 123456789};
  const std::string text = verdictText(report);
  // yaml.safe_load("[1e-06, 1.0e-06]") -> ['1e-06', 1e-06], PyYAML 6.0
  EXPECT_TRUE(test_support::holds(text, {"value: 1.0e-06", "interval: [-2.5e-07, 123460000]"}));
}

// Verdicts of earlier versions hold absolute paths.
TEST_F(VerdictOnDisk, ReadsAVerdictWithAbsolutePaths) {
  EXPECT_EQ(complaint("simulate --gap found/verdict.yaml --drive 1_flat.bag",
                      "simulate --gap /data/found/verdict.yaml --drive /data/1_flat.bag"),
            "");
}

TEST_F(VerdictOnDisk, ReadsBackTheSame) {
  const discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  write(verdictText(report));
  const VerdictFile verdict = readVerdict(path_);
  EXPECT_EQ(verdict.verdict, "named");
  EXPECT_EQ(verdict.effects, (std::vector<std::string>{"hysteresis"}));
  EXPECT_EQ(verdict.credible_set, report.credible_set);
  ASSERT_EQ(verdict.inputs.size(), 2u);
  EXPECT_EQ(verdict.inputs[1].sha256, report.inputs[1].sha256);
  EXPECT_EQ(verdict.inputs[1].hold_out_opened, 3);
  EXPECT_EQ(verdict.version, "0.1.0");
  EXPECT_EQ(verdict.gap_before, 0.031);
  EXPECT_EQ(verdict.gap_after, 0.008);
  ASSERT_EQ(verdict.gap_surfaces.size(), 2u);
  EXPECT_EQ(verdict.gap_surfaces[1].surface, "cylinder_7cm");
  EXPECT_EQ(verdict.gap_surfaces[1].after, 0.009);
  ASSERT_EQ(verdict.hold_out.size(), 2u);
  EXPECT_EQ(verdict.hold_out[1].file, "2_bent.bag");
  EXPECT_EQ(verdict.hold_out[1].cycles, report.hold_out[1].cycles) << "to the nanosecond";
}

// Files of earlier versions lack them.
TEST_F(VerdictOnDisk, NeedsNoneOfTheAddedFields) {
  std::string text = verdictText(exampleDiscrepancy());
  const std::size_t from = text.find("p: 0.0033"), to = text.find("not_identifiable:");
  write(text.erase(from, to - from));
  EXPECT_EQ(readVerdict(path_).verdict, "named");
}

TEST_F(VerdictOnDisk, RefusalsNameTheFieldAndWhatWouldBeRight) {
  const std::vector<std::vector<std::string>> cases = {
      {"verdict: named", "verdict: sure", "verdict is sure", "not_identifiable"},
      {"verdict: named", "verdict: named\nverdikt: named", "verdikt is not a known setting"},
      {"seed: 1", "# seed: 1", "seed is missing"},
      {"seed: 1", "seed: many", "seed is many, but must be a whole number"},
      {"- {id: hysteresis,", "- {id: histeresis,", "effects[0].id", "histeresis"},
      {"[[hysteresis]]", "[[magic]]", "credible_set", "magic"},
      {"[[hysteresis]]", "hysteresis", "credible_set", "must be a list of lists"},
      {"hold_out:", "held_out:", "hold_out is missing"},
      {"cycles: [[946684875.100000000, 946684950.000000000]]", "cycles: 3", "hold_out[0].cycles", "lists"},
      {"[946684875.100000000, 946684950.000000000]", "[946684950.0, 946684875.1]", "hold_out[0].cycles",
       "ends before"},
      {"[946684875.100000000, ", "[now, ", "hold_out[0].cycles", "stamps"},
      {"[946684875.100000000, ", "[99999999999.0, ", "hold_out[0].cycles", "stamps"},
      {"before: 0.031", "before: large", "gap.before", "number"},
      {"{surface: flat, before: 0.03,", "{surface: flat, before: low,", "gap.surfaces[0].before", "number"},
      {"show_opened: 3", "show_opened: -3", "inputs[1].show_opened", "0 to"},
      {"sha256: bb", "sha256: b", "inputs[1].sha256", "64"},
  };
  for (const auto& parts : cases) {
    const std::string said = complaint(parts[0], parts[1]);
    EXPECT_NE(said.find(path_), std::string::npos) << parts[1] << ": " << said;
    for (std::size_t i = 2; i < parts.size(); ++i) EXPECT_NE(said.find(parts[i]), std::string::npos) << said;
  }
  write("verdict: [");
  EXPECT_THROW(readVerdict(path_), settings::InputError);
  EXPECT_THROW(readVerdict("/no/such/verdict.yaml"), settings::InputError);
}

TEST_F(VerdictOnDisk, PredictionKeepsEveryBit) {
  discrepancy::Prediction prediction = exampleDiscrepancy().prediction;
  prediction.effects[0].carried_over = false;
  write(predictionText(
      {prediction, std::string(64, 'd'), {{17e3, 2, 620e3}, {40e3, 8.5, 620e3}}, {"ab12", "34"}}));
  const FrozenPrediction read = readPrediction(path_);
  EXPECT_EQ(read.verdict_sha256, std::string(64, 'd'));
  EXPECT_EQ(read.prediction.hash, prediction.hash);
  EXPECT_EQ(read.prediction.size.high, prediction.size.high);
  EXPECT_EQ(read.prediction.weights, prediction.weights);
  EXPECT_EQ(read.prediction.spread.covariance, prediction.spread.covariance);
  EXPECT_EQ(read.prediction.spread.between, prediction.spread.between);
  EXPECT_EQ(read.prediction.spread.cycles, 24u);
  EXPECT_EQ(read.prediction.spread.groups, 3u);
  ASSERT_EQ(read.paces.size(), 2u);
  EXPECT_EQ(read.paces[1].dwell, 8.5);
  EXPECT_EQ(read.readings_sha256, (std::vector<std::string>{"ab12", "34"}));
  ASSERT_EQ(read.prediction.spread.parameters.size(), 2u);
  EXPECT_EQ(read.prediction.spread.parameters[1].name, "threshold");
  EXPECT_TRUE(read.prediction.spread.parameters[1].logarithmic);
  ASSERT_EQ(read.prediction.effects.size(), 1u);
  EXPECT_EQ(read.prediction.effects[0].values, prediction.effects[0].values);
  EXPECT_FALSE(read.prediction.effects[0].carried_over);
  ASSERT_EQ(read.prediction.rivals.size(), 2u);
  EXPECT_EQ(read.prediction.rivals[1][0].id, "time_skew");
}

TEST_F(VerdictOnDisk, PredictionKeepsAnInfiniteTimeConstant) {
  discrepancy::Prediction prediction;
  prediction.rivals = {{{"drift", {{"rate", -0.002}, {"time_constant", INFINITY}}}}};
  write(predictionText({prediction, std::string(64, 'd')}));
  EXPECT_EQ(readPrediction(path_).prediction.rivals[0][0].values, prediction.rivals[0][0].values);
}

TEST_F(VerdictOnDisk, ReadsBackAnEmptyPrediction) {
  write(predictionText({{}, "x"}));
  EXPECT_TRUE(readPrediction(path_).prediction.effects.empty());
  EXPECT_TRUE(readPrediction(path_).prediction.rivals.empty());
}

}  // namespace
}  // namespace fsr::report
