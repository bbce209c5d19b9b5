// One file of every schema is kept in test/data and must load.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "hdf5/file.h"
#include "support/source_dir.h"

namespace fsr::calibration {
namespace {

const std::string kFolder = test_support::sourceDir() + "/test/data/calibrations/";

TEST(OldCalibrationFiles, AllLoadAndCalibrate) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    const Calibration calibration = loadCalibration(entry.path().string(), CalibrationParts::kAll);
    EXPECT_NO_THROW(Calibrator(calibration.tables, calibration.layout)) << entry.path();
    EXPECT_FALSE(calibration.statistics->cells.empty()) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 3);
}

TEST(OldCalibrationFiles, SchemaOneIsReadAsBefore) {
  const Calibration calibration = loadCalibration(kFolder + "schema_1.h5");
  EXPECT_EQ(calibration.id, "6a1d3370726e");
  EXPECT_EQ(calibration.tables.scheme, compensation::Scheme::kPerCurvature);
  EXPECT_EQ(calibration.tables.rule.blend, compensation::BlendRule::kNearest);
  EXPECT_EQ(calibration.regressor.name, "grnn");
  EXPECT_EQ(calibration.regressor.grnn.bandwidth, regression::kPaperBandwidth);
  EXPECT_FALSE(calibration.bandwidth_chosen);
  EXPECT_EQ(calibration.tables.classes.at(1).surface, "cylinder_7cm");
  EXPECT_EQ(calibration.sensor.serial, "0001");
  EXPECT_FLOAT_EQ(calibration.tables.table(1, 1).pressure.at(100), 185000.0f);
  EXPECT_FLOAT_EQ(calibration.tables.table(1, 1).deviation.at(100), 7500.0f);
  EXPECT_DOUBLE_EQ(calibration.scores.whole.rmse_percent.mean, 0.35330320417948624);
}

TEST(OldCalibrationFiles, SchemaTwoIsReadAsBefore) {
  const Calibration calibration = loadCalibration(kFolder + "schema_2.h5");
  EXPECT_EQ(calibration.tables.scheme, compensation::Scheme::kScaledCurvature);
  EXPECT_EQ(calibration.tables.rule.blend, compensation::BlendRule::kKernel);
  EXPECT_EQ(calibration.tables.rule.length_scale, std::vector<double>{0.22265625});
  EXPECT_FLOAT_EQ(calibration.tables.table(1, 1).log_weight.at(100), 1.60943794f);
  EXPECT_FLOAT_EQ(calibration.tables.table(1, 1).pressure.at(100), 180000.0f);
  EXPECT_NEAR(calibration.scores.unseen.rmse, 28211.1804, 1e-4);
}

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Of version 0.2.0, with every part but a correction and a shape.
TEST(OldCalibrationFiles, SchemaThreeIsWrittenAgainByteForByte) {
  const Calibration calibration = loadCalibration(kFolder + "schema_3.h5", CalibrationParts::kAll);
  EXPECT_TRUE(calibration.history.present());
  EXPECT_TRUE(calibration.history.memory_spread.empty());
  EXPECT_TRUE(calibration.session_zero.expected());
  EXPECT_TRUE(calibration.temperature.present());
  EXPECT_TRUE(calibration.budget.intervals.scale.present());
  EXPECT_EQ(calibration.provenance.tool_version, "0.2.0");
  EXPECT_EQ(calibration.scores.session.sessions.size(), 5u);
  EXPECT_NEAR(calibration.budget.combined[1], 8650, 1);
  const std::string again = testing::TempDir() + "schema_3_" + std::to_string(::getpid()) + ".h5";
  saveCalibration(calibration, again);
  // The errors with and without the temperature mean something else in new files, which the file says.
  std::string expected = bytesOf(kFolder + "schema_3.h5"), written = bytesOf(again);
  const std::string before = "of means over half a second: without",
                    now = "of readings on a linear map: without";
  const std::size_t place = expected.find(before);
  ASSERT_NE(place, std::string::npos);
  expected.replace(place, before.size(), now);
  ASSERT_EQ(written.size(), expected.size());
  std::size_t differing = 0;
  for (std::size_t i = hdf5::kUserBlock; i < expected.size(); ++i) differing += written[i] != expected[i];
  EXPECT_LE(differing, 4u) << "the checksum of the attributes";
  std::remove(again.c_str());
}

}  // namespace
}  // namespace fsr::calibration
