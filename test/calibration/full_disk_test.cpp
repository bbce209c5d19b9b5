// A full disk or a kill while a calibration or a tare is replaced: the old file stays complete.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "calibration/stages/session/tare.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/leaks_of_others.h"
#include "support/small_calibration.h"
#include "support/small_disk.h"

namespace fsr::calibration {
namespace {

namespace fs = std::filesystem;
using test_support::smallCalibration;

std::size_t filesIn(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

void fill(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  const std::string kilobyte(1024, 'x');
  while (file.write(kilobyte.data(), 1024).flush()) {
  }
}

TEST(FullDisk, KeepsTheOldCalibration) {
  const test_support::SmallDisk disk("1m");
  if (!disk.ready()) GTEST_SKIP() << "a small file system can be mounted by root alone";
  const test_support::LeaksOfOthers of_hdf5;  // HDF5 leaks a buffer of 1 KB if it cannot close a dataset
  const std::string path = disk.path("calibration.h5");
  const std::string id = saveCalibration(smallCalibration({3, 4}, {0.0}), path);
  const std::size_t open_files = filesIn("/proc/self/fd");
  fill(disk.path("filler"));
  try {
    saveCalibration(smallCalibration({3, 4}, {0.0, 10.0, 20.0}), path);
    ADD_FAILURE() << "there is no room for it";
  } catch (const settings::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left on device"), std::string::npos) << error.what();
  }
  EXPECT_EQ(loadCalibration(path).id, id);
  EXPECT_EQ(filesIn(disk.path("")), 2u) << "nothing half-written is left";
  EXPECT_EQ(filesIn("/proc/self/fd"), open_files) << "a file that is open takes up the disk, name or not";
}

TEST(FullDisk, KeepsTheOldTare) {
  const test_support::SmallDisk disk("64k");
  if (!disk.ready()) GTEST_SKIP() << "a small file system can be mounted by root alone";
  const std::string path = disk.path("tare.yaml");
  Tare tare;
  tare.calibration = "abc";
  tare.date = "2026-03-01T12:00:00Z";
  tare.size = {3, 4};
  tare.offset.assign(12, 1000.0f);
  saveTare(tare, path);
  fill(disk.path("filler"));
  tare.offset.assign(12, 2000.0f);
  EXPECT_THROW(saveTare(tare, path), settings::InputError);
  EXPECT_EQ(loadTare(path).offset, std::vector<float>(12, 1000.0f));
  EXPECT_EQ(filesIn(disk.path("")), 2u);
}

// A writer in a loop, killed at random times.
TEST(Kill, LeavesACompleteCalibrationAtAnyTime) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder.path("calibration.h5");
  const std::string first = saveCalibration(smallCalibration({3, 4}, {0.0}), path);
  const Calibration other = smallCalibration({3, 4}, {0.0, 10.0});
  const std::string second = saveCalibration(other, folder.path("other.h5"));
  for (int round = 0; round < 25; ++round) {
    const pid_t writer = fork();
    if (writer == 0) {
      while (true) saveCalibration(other, path);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1 + 3 * round));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    const std::string id = loadCalibration(path).id;
    ASSERT_TRUE(id == first || id == second) << "round " << round;
  }
}

}  // namespace
}  // namespace fsr::calibration
