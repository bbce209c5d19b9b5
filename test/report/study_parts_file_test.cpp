
#include <unistd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/shard_file.h"
#include "report/study/study_report.h"
#include "support/holds.h"
#include "support/memory_rig.h"
#include "support/synthetic_recording.h"

namespace {

using fsr::study::StudyParts;
using fsr::study::StudyProblem;

StudyProblem quick(const std::vector<fsr::dataset::Recording>& recordings) {
  StudyProblem problem{recordings, {}, ""};
  problem.plan.forest.trees = 2;
  problem.plan.resamples = 99;
  problem.plan.bandwidths = {1.0 / 128, 1.0 / 16};
  problem.plan.bandwidth_taxels = 1;
  problem.plan.date = "2024-01-01T00:00:00Z";
  return problem;
}

// Several protocols, so that a model of the sheet's memory is chosen.
StudyProblem withMemory() {
  test_support::MemoryRig rig;
  rig.program = test_support::variedProgram();
  rig.loop = 0.08;
  return quick({test_support::memoryRecording(rig)});
}

// Each surface was mounted twice, so that mounts are resampled.
StudyProblem remounted() {
  test_support::SyntheticRig rig;
  rig.size = {1, 3};
  rig.surfaces = {{"flat", 0.0}, {"cylinder_13cm", 7.7}, {"cylinder_5cm", 20.0}};
  rig.scans_per_cycle = 30;
  rig.noise = 60;
  std::vector<fsr::dataset::Recording> recordings;
  for (std::uint32_t i = 0; i < 2; ++i) {
    rig.seed = i + 1;
    recordings.push_back(test_support::syntheticRecording(rig));
    for (fsr::matrix::Surface& surface : recordings.back().conditions) surface.mount = i + 1;
  }
  return quick(recordings);
}

class StudyPartsFile : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "study_parts_file_test_" + std::to_string(::getpid()) + ".json";

  void TearDown() override { std::filesystem::remove(path_); }

  StudyParts writtenAndRead(const StudyParts& parts) const {
    std::ofstream(path_) << fsr::report::studyPartsJson(parts);
    return fsr::report::readStudyParts(path_);
  }

  // The study of three computers.
  fsr::study::StudyResult shared(StudyProblem problem) const {
    StudyParts all;
    for (fsr::report::Shard shard{1, 3}; shard.number <= shard.of; ++shard.number) {
      problem.plan.threads = static_cast<unsigned>(shard.number);
      StudyParts own = writtenAndRead(
          fsr::study::computeParts(problem, [&](std::size_t piece) { return shard.has(piece); }, {}));
      if (shard.number == 1) {
        all = std::move(own);
      } else {
        fsr::report::addStudyParts(std::move(own), "b.json", "a.json", all);
      }
    }
    return fsr::study::joinParts(all);
  }

  static std::string refusal(const std::function<void()>& call) {
    return test_support::refusal([&] { call(); });
  }
};

void expectSame(const fsr::study::StudyResult& one, const fsr::study::StudyResult& other) {
  EXPECT_EQ(fsr::report::studyText(one), fsr::report::studyText(other));
  EXPECT_TRUE(fsr::report::studyJson(one) == fsr::report::studyJson(other));
  EXPECT_TRUE(fsr::report::studyTables(one) == fsr::report::studyTables(other));
}

TEST_F(StudyPartsFile, OfThreeComputersMakeTheStudyOfOneWithTheMemoryOfTheSheet) {
  const fsr::study::StudyResult one = fsr::study::study(withMemory());
  ASSERT_EQ(one.splits.back().scores.back().id, "history");
  expectSame(shared(withMemory()), one);
}

TEST_F(StudyPartsFile, OfThreeComputersMakeTheStudyOfOneWithIntervalsOverMounts) {
  const fsr::study::StudyResult one = fsr::study::study(remounted());
  ASSERT_EQ(one.comparisons.front().differences.front().rmse_percent.level, "mount");
  ASSERT_FALSE(one.curvature_errors.empty());
  expectSame(shared(remounted()), one);
}

TEST_F(StudyPartsFile, KeepEveryDigitAndWhatIsNotFinite) {
  const std::vector<double> values = {0.1,
                                      -0.0,
                                      std::nextafter(1.0, 2.0),
                                      std::numeric_limits<double>::denorm_min(),
                                      std::numeric_limits<double>::max(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::quiet_NaN()};
  StudyParts parts;
  parts.pieces_of_study = 8;
  parts.computed[7].compared.push_back({{}, fsr::study::CycleSums({8, 1, 1, 0.3, values, {2}})});
  parts.computed[7].compared[0].score.r2 = values;
  const StudyParts read = writtenAndRead(parts);
  ASSERT_EQ(read.computed.count(7), 1u);
  const fsr::study::ScoredMethod& method = read.computed.at(7).compared.at(0);
  for (const std::vector<double>& list : {method.score.r2, method.sums.values().squares}) {
    ASSERT_EQ(list.size(), values.size());
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      EXPECT_EQ(list[i], values[i]) << i;
      EXPECT_EQ(std::signbit(list[i]), std::signbit(values[i])) << i;
    }
    EXPECT_TRUE(std::isnan(list.back()));
  }
}

TEST_F(StudyPartsFile, IsRefusedIfItCannotBeRead) {
  StudyParts parts;
  parts.computed[0].compared.push_back({{}, fsr::study::CycleSums({1, 1, 2, 0.3, {4, 5}, {1, 1}})});
  const std::string whole = fsr::report::studyPartsJson(parts);
  std::string fewer = whole;
  fewer.replace(fewer.find("[4.0,5.0]"), 9, "[4.0]");
  for (const std::string& text :
       {std::string(), whole.substr(0, whole.size() / 2), fewer, std::string("[]")}) {
    std::ofstream(path_) << text;
    EXPECT_TRUE(test_support::holds(refusal([&] { fsr::report::readStudyParts(path_); }),
                                    {path_, "cannot be read as the pieces of a study"}))
        << text;
  }
}

TEST_F(StudyPartsFile, OfAnotherStudyIsNotAdded) {
  StudyParts parts, other;
  parts.frame.scans = other.frame.scans = 10;
  other.computed[3].part = "methods";
  other.frame.provenance.date = "2030-01-01T00:00:00Z";
  fsr::report::addStudyParts(other, "b.json", "a.json", parts);
  EXPECT_EQ(parts.computed.count(3), 1u);
  EXPECT_EQ(refusal([&] { fsr::report::addStudyParts(other, "b.json", "a.json", parts); }),
            "b.json: has piece 3 of the study, which is there already");
  other.frame.scans = 11;
  EXPECT_TRUE(
      test_support::holds(refusal([&] { fsr::report::addStudyParts(other, "b.json", "a.json", parts); }),
                          {"b.json", "a.json", "describes other recordings than a.json"}));
}

}  // namespace
