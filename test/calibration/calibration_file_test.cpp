#include "fsr_pressure_map/calibration/calibration_file.h"
#include "compensation/training_statistics.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_complaint.h"
#include "support/holds.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

using test_support::syntheticRecording;
using test_support::SyntheticRig;

class CalibrationFile : public testing::Test {
 protected:
  ~CalibrationFile() override { std::remove(path_.c_str()); }

  std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& content) const { std::ofstream(path_, std::ios::binary) << content; }
  std::string complaint() const { return test_support::fileComplaint(path_); }

  const std::string path_ = testing::TempDir() + "calibration_" + std::to_string(::getpid()) + ".h5";
};

Calibration small() {
  SyntheticRig rig;
  rig.size = {2, 2};
  rig.full_scale = 1023;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_5cm", 20.0}};
  rig.cycles = 5;
  rig.scans_per_cycle = 60;
  dataset::Recording recording = syntheticRecording(rig);
  recording.layout.pitch_x = 0.0125;
  recording.sensor = {"matrix_a", "0001", "1.2", "TPE-900", "pdms", "gauge 7, calibrated 2024-01-02"};
  recording.mask = {0, 0, 1, 0};  // one table of NaN
  recording.warnings = {"a warning"};
  recording.conditions[1].curvature = {{18, 0, 0}, {19, 0, 0}, {20, 0, 0}, {21, 1, 2}};
  CalibrationProblem problem{{recording}, {}};
  problem.options.date = "2024-05-06T07:08:09Z";
  return calibrate(problem);
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void expectSameErrors(const statistics::ErrorSummary& a, const statistics::ErrorSummary& b) {
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
}

void expectSameScore(const Score& a, const Score& b) {
  EXPECT_EQ(a.readings, b.readings);
  EXPECT_EQ(a.r2.mean, b.r2.mean);
  EXPECT_EQ(a.r2.deviation, b.r2.deviation);
  EXPECT_EQ(a.rmse_percent.mean, b.rmse_percent.mean);
  EXPECT_EQ(a.rmse_percent.deviation, b.rmse_percent.deviation);
  EXPECT_EQ(a.worst_taxel, b.worst_taxel);
  EXPECT_EQ(a.worst_rmse_percent, b.worst_rmse_percent);
  EXPECT_EQ(a.within_one_deviation, b.within_one_deviation);
  expectSameErrors(a.errors.whole.unloading, b.errors.whole.unloading);
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
    expectSameErrors(a.errors.bins[bin].all, b.errors.bins[bin].all);
    expectSameErrors(a.errors.bins[bin].loading, b.errors.bins[bin].loading);
  }
}

TEST_F(CalibrationFile, RestoresTheTablesBitForBit) {
  const Calibration saved = small();
  const std::string id = saveCalibration(saved, path_);
  const Calibration loaded = loadCalibration(path_);
  EXPECT_EQ(loaded.id, id);
  EXPECT_EQ(id.size(), 12u);
  EXPECT_EQ(loaded.tables.scheme, compensation::Scheme::kInterpolated);
  EXPECT_EQ(loaded.tables.size, saved.tables.size);
  EXPECT_EQ(loaded.tables.full_scale, 1023);
  EXPECT_EQ(loaded.tables.curvature_high, saved.tables.curvature_high);
  EXPECT_EQ(loaded.tables.class_tolerance, saved.tables.class_tolerance);
  ASSERT_EQ(loaded.tables.classes.size(), 2u);
  EXPECT_EQ(loaded.tables.classes[0].curvature, std::vector<double>{0.0});
  EXPECT_EQ(loaded.tables.classes[1].curvature, saved.tables.classes[1].curvature);
  ASSERT_EQ(loaded.tables.tables.size(), saved.tables.tables.size());
  for (std::size_t i = 0; i < saved.tables.tables.size(); ++i) {
    EXPECT_TRUE(sameBits(loaded.tables.tables[i].pressure, saved.tables.tables[i].pressure));
    EXPECT_TRUE(sameBits(loaded.tables.tables[i].deviation, saved.tables.tables[i].deviation));
    EXPECT_TRUE(sameBits(loaded.tables.tables[i].support, saved.tables.tables[i].support));
    EXPECT_EQ(loaded.tables.tables[i].lowest, saved.tables.tables[i].lowest);
    EXPECT_EQ(loaded.tables.tables[i].highest, saved.tables.tables[i].highest);
  }
  EXPECT_EQ(loaded.no_model, (std::vector<std::uint8_t>{0, 0, 1, 0}));
}

TEST_F(CalibrationFile, RestoresTheOptionsOfTheModel) {
  Calibration saved = small();
  saved.bandwidth_chosen = true;
  saved.regressor.grnn = {0.5, regression::SpreadMeaning::kHalf, regression::KernelDistance::kLiteral,
                          regression::SampleWeighting::kEachPressureBin};
  saved.regressor.forest.trees = 20;
  saved.regressor.forest.minimum_leaf = 9;
  saved.regressor.forest.leaf_count = regression::LeafCount::kDistinct;
  saveCalibration(saved, path_);
  const Calibration loaded = loadCalibration(path_);
  EXPECT_TRUE(loaded.bandwidth_chosen);
  EXPECT_EQ(loaded.regressor.grnn.bandwidth, saved.regressor.grnn.bandwidth);
  EXPECT_EQ(loaded.regressor.grnn.bandwidth, 0.5);
  EXPECT_EQ(loaded.regressor.grnn.spread, regression::SpreadMeaning::kHalf);
  EXPECT_EQ(loaded.regressor.grnn.distance, regression::KernelDistance::kLiteral);
  EXPECT_EQ(loaded.regressor.grnn.weighting, regression::SampleWeighting::kEachPressureBin);
  EXPECT_EQ(loaded.regressor.forest.trees, 20u);
  EXPECT_EQ(loaded.regressor.forest.minimum_leaf, 9u);
  EXPECT_EQ(loaded.regressor.forest.leaf_count, regression::LeafCount::kDistinct);
}

TEST_F(CalibrationFile, RestoresTheProvenance) {
  const Calibration saved = small();
  saveCalibration(saved, path_);
  const Calibration loaded = loadCalibration(path_);
  EXPECT_EQ(loaded.regressor.name, "grnn");
  EXPECT_EQ(loaded.bandwidth_chosen, saved.bandwidth_chosen);
  EXPECT_EQ(loaded.folds, 5u);
  EXPECT_EQ(loaded.sensor.serial, "0001");
  EXPECT_EQ(loaded.sensor.transducer, "gauge 7, calibrated 2024-01-02");
  EXPECT_EQ(loaded.layout.pitch_x, 0.0125);
  EXPECT_EQ(loaded.trained.pressure.high, saved.trained.pressure.high);
  EXPECT_EQ(loaded.trained.pressure_rate.low, saved.trained.pressure_rate.low);
  EXPECT_FALSE(loaded.trained.temperature.known());
  EXPECT_EQ(loaded.provenance.date, "2024-05-06T07:08:09Z");
  EXPECT_EQ(loaded.provenance.tool_version, saved.provenance.tool_version);
  ASSERT_EQ(loaded.provenance.bags.size(), 1u);
  EXPECT_EQ(loaded.provenance.bags[0].sha256, std::string(64, 'a'));
  EXPECT_EQ(loaded.provenance.bags[0].scans, 600u);
  EXPECT_EQ(loaded.warnings, saved.warnings);
  EXPECT_EQ(loaded.coverage.thin, saved.coverage.thin);
  EXPECT_EQ(loaded.coverage.conditions.at(1).unloading[3].scans,
            saved.coverage.conditions[1].unloading[3].scans);
  EXPECT_EQ(loaded.coverage.conditions[1].pressure_high, 600e3);
}

TEST_F(CalibrationFile, RestoresScoresAndStatistics) {
  const Calibration saved = small();
  saveCalibration(saved, path_);
  const Calibration loaded = loadCalibration(path_, CalibrationParts::kAll);
  EXPECT_EQ(loaded.statistics->cells, saved.statistics->cells);
  EXPECT_EQ(loaded.statistics->sections, 5u);
  EXPECT_EQ(loaded.statistics->taxels, 4u);
  ASSERT_EQ(loaded.scores.conditions.size(), 2u);
  EXPECT_TRUE(loaded.scores.conditions[1].trained);
  expectSameScore(loaded.scores.conditions[1].score, saved.scores.conditions[1].score);
  expectSameScore(loaded.scores.whole, saved.scores.whole);
  EXPECT_EQ(loadCalibration(path_).statistics, nullptr);
}

TEST_F(CalibrationFile, OfTheSameCalibrationHasTheSameBytes) {
  const Calibration calibration = small();
  saveCalibration(calibration, path_);
  const std::string first = bytes();
  saveCalibration(calibration, path_);
  EXPECT_EQ(bytes(), first);
}

std::vector<int> allChanges() {
  std::vector<int> changes(255);
  std::iota(changes.begin(), changes.end(), 1);
  return changes;
}

bool isRefusedAsDamaged(const std::string& complaint) {
  for (const char* const why :
       {"is damaged or cut short: its bytes do not have the SHA-256", "is no calibration file;",
        "has schema ", "is damaged: its first line names schema "}) {
    if (complaint.find(why) != std::string::npos) return true;
  }
  return false;
}

TEST_F(CalibrationFile, BeginsWithOneLineOfText) {
  saveCalibration(small(), path_);
  const std::string content = bytes();
  EXPECT_EQ(content.substr(0, 45), "fsr_pressure_map calibration schema=2 sha256=");
  EXPECT_EQ(content[45 + 64], '\n');
  EXPECT_EQ(content.find_first_not_of('\0', 45 + 65), 512u);
  EXPECT_EQ(content.substr(513, 3), "HDF");
}

// Changes one byte after the other: every second one in the line of text, and after it the complement and
// single bits. No error message is from HDF5: it reads a file only after its content agrees with the hash.
TEST_F(CalibrationFile, AnyChangedByteIsRefused) {
  SyntheticRig rig;
  rig.size = {1, 1};
  rig.full_scale = 63;
  rig.scans_per_cycle = 8;
  CalibrationProblem problem{{syntheticRecording(rig)}, {}};
  problem.options.scores = false;
  saveCalibration(calibrate(problem), path_);
  const std::string whole = bytes();
  std::FILE* const file = std::fopen(path_.c_str(), "r+b");
  ASSERT_NE(file, nullptr);
  const auto put = [&](std::size_t at, char byte) {
    std::fseek(file, static_cast<long>(at), SEEK_SET);
    std::fputc(byte, file);
    std::fflush(file);
  };
  const std::size_t line = whole.find('\n') + 1;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int change : at < line ? allChanges() : std::vector<int>{0xFF, 1 << (at % 8)}) {
      put(at, static_cast<char>(whole[at] ^ change));
      ASSERT_TRUE(isRefusedAsDamaged(complaint())) << "byte " << at << " ^ " << change << ": " << complaint();
    }
    put(at, whole[at]);
  }
  std::fclose(file);
  EXPECT_EQ(complaint(), "accepted");
}

TEST_F(CalibrationFile, ACutFileIsRefused) {
  saveCalibration(small(), path_);
  const std::string whole = bytes();
  const std::string damaged =
      "is damaged or cut short: its bytes do not have the SHA-256 that its first line names; copy the "
      "file again or train again";
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{513}, std::size_t{512},
                                 std::size_t{100}, std::size_t{39}}) {
    write(whole.substr(0, size));
    EXPECT_EQ(complaint(), damaged) << size;
  }
  write(whole + "x");
  EXPECT_EQ(complaint(), damaged);
  write("");
  EXPECT_TRUE(test_support::holds(complaint(), {"is empty"}));
}

TEST_F(CalibrationFile, AForeignFileIsRefused) {
  const std::string foreign = "is no calibration file; give one that train has written";
  write("#ROSBAG V2.0\n");
  EXPECT_EQ(complaint(), foreign);
  EXPECT_THROW(saveCalibration(small(), path_), settings::InputError);  // another's file
  std::remove(path_.c_str());
  saveCalibration(small(), path_);
  write(bytes().substr(512));  // HDF5 without our first line
  EXPECT_EQ(complaint(), foreign);
  std::filesystem::resize_file(path_, std::uintmax_t{1} << 36);  // needs no space on the disk or in memory
  EXPECT_EQ(complaint(), foreign);
  EXPECT_THROW(loadCalibration("/"), settings::InputError);
  std::remove(path_.c_str());
  EXPECT_TRUE(test_support::holds(complaint(), {"there is no such file"}));
}

TEST_F(CalibrationFile, AnUnknownSchemaIsRefusedByNumber) {
  saveCalibration(small(), path_);
  std::string content = bytes();
  content.replace(content.find("schema=2"), 8, "schema=7");
  write(content);
  EXPECT_TRUE(test_support::holds(complaint(), {"has schema 7"}));
  content.replace(content.find("schema=7"), 8, "schema=0");
  write(content);
  EXPECT_TRUE(test_support::holds(complaint(), {"1 to 3", "has schema 0"}));
}

// The hash covers the content, not the first line.
TEST_F(CalibrationFile, AChangedSchemaIsRefused) {
  saveCalibration(small(), path_);
  std::string content = bytes();
  content.replace(content.find("schema=2"), 8, "schema=1");
  write(content);
  EXPECT_TRUE(test_support::holds(complaint(), {"is damaged"}));
}

TEST_F(CalibrationFile, AFailedWriteKeepsTheOldFile) {
  write("old");
  const std::string directory = path_ + "_no_such_directory/";
  EXPECT_THROW(saveCalibration(small(), directory + "calibration.h5"), settings::InputError);
  EXPECT_EQ(bytes(), "old");
}

// The text that h5py prints is compared with what was saved.
TEST_F(CalibrationFile, OpensInPythonWithUnits) {
  const Calibration saved = small();
  saveCalibration(saved, path_);
  const std::string script =
      "import h5py, sys\n"
      "f = h5py.File(sys.argv[1], 'r')\n"
      "t = f['tables/pressure']\n"
      "text = lambda value: value.decode() if isinstance(value, bytes) else str(value)\n"
      "print(f.userblock_size, t.shape, t.dtype, text(t.attrs['unit']), '%.9g' % t[1, 1, 500],\n"
      "      f['tables/surfaces'][1].decode(), text(f.attrs['scheme']), f['statistics/count'][:].sum(),\n"
      "      text(f['layout'].attrs['unit']), f['trained'].attrs['pressure'][1])\n";
  const std::string command = "/usr/bin/python3 -c \"" + script + "\" " + path_ + " 2>&1";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char printed[512] = "";
  const std::size_t size = std::fread(printed, 1, sizeof(printed) - 1, pipe);
  printed[size] = '\0';
  ::pclose(pipe);
  if (std::strstr(printed, "No module named 'h5py'") != nullptr)
    GTEST_SKIP() << "python3-h5py is not installed";
  char expected[512];
  std::snprintf(expected, sizeof(expected),
                "512 (4, 2, 1024) float32 Pa %.9g cylinder_5cm interpolated 2400 m 600000.0\n",
                static_cast<double>(saved.tables.table(1, 1).pressure[500]));
  EXPECT_STREQ(printed, expected);
}

}  // namespace
}  // namespace fsr::calibration
