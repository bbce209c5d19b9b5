// A calibration does not depend on where the counts of its recordings are.

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "support/counts_in_file.h"
#include "support/memory_rig.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

// SHA-256 of the file without its date.
std::string idOf(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options) {
  Calibration calibration = calibrate({recordings, options});
  calibration.provenance.date.clear();
  const std::string path =
      (std::filesystem::temp_directory_path() / ("long_recording_" + std::to_string(::getpid()) + ".h5"));
  const std::string id = saveCalibration(calibration, path);
  std::filesystem::remove(path);
  return id;
}

void expectTheSame(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options) {
  EXPECT_EQ(idOf(test_support::countsInFiles(recordings), options), idOf(recordings, options));
}

TEST(LongRecording, GivesTheSameTablesScoresAndShape) {
  test_support::SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_7cm", 14.3}, {"cylinder_9cm", 11.1}};
  rig.scans_per_cycle = 300;
  expectTheSame({test_support::syntheticRecording(rig)}, {});
}

TEST(LongRecording, GivesTheSameForest) {
  CalibrationOptions options;
  options.regressor.name = "forest";
  options.regressor.forest.trees = 5;
  expectTheSame({test_support::syntheticRecording({})}, options);
}

TEST(LongRecording, GivesTheSameHistory) {
  test_support::MemoryRig rig;
  rig.program = test_support::variedProgram();
  rig.loop = 0.08;
  CalibrationOptions options;
  expectTheSame({test_support::memoryRecording(rig)}, options);
}

TEST(LongRecording, GivesTheSameZeros) {
  std::vector<dataset::Recording> sessions;
  for (std::size_t i = 0; i < 7; ++i) sessions.push_back(test_support::memorySession(i, 20e3));
  expectTheSame(sessions, {});
}

}  // namespace
}  // namespace fsr::calibration
