// Marks of the operator, with scans of a planted sheet whose shape is known.

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/live_calibration.h"
#include "support/holds.h"
#include "support/planted_shape.h"
#include "support/small_calibration.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

constexpr double kAmbient = 101325;  // [Pa]
constexpr double kPatience = 20;     // [s]
constexpr double kBend = 9;          // of the sheet, one of those of training [1/m]

class LiveMarks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    file() = fs::path(testing::TempDir()) / ("marks_" + std::to_string(::getpid()) + ".h5");
    fsr::calibration::Calibration calibration =
        test_support::smallCalibration({4, 5}, {0.0, 20.0}, "board-1", test_support::kPlantedFullScale);
    calibration.shape = test_support::learnPlanted({});
    calibration.shape.layout = calibration.layout;
    fsr::calibration::saveCalibration(calibration, file());
  }
  static void TearDownTestSuite() { fs::remove(file()); }
  static fs::path& file() {
    static fs::path path;
    return path;
  }
  static CalibrationSettings settings() {
    CalibrationSettings settings;
    settings.tare.window = 0.5;
    settings.tare.limit = 100e3;  // the tables of the small calibration are not those of the planted sheet
    settings.tare_file = testing::TempDir() + "marks_tare_" + std::to_string(::getpid()) + ".yaml";
    settings.mask_file = testing::TempDir() + "marks_mask_" + std::to_string(::getpid()) + ".yaml";
    return settings;
  }

  void SetUp() override {
    live.load(file());
    lieOn(kBend);
    scan.rows = 4;
    scan.columns = 5;
    scan.full_scale = test_support::kPlantedFullScale;
    for (const double count : test_support::readingOf(test_support::plantedRest({}, kBend)).reading)
      scan.counts.push_back(static_cast<std::uint16_t>(std::lround(count)));
  }

  void lieOn(double curvature) {
    fsr_pressure_map::SurfaceCurvature surface;
    surface.header.stamp.fromSec(time);
    surface.surface = "declared";
    surface.x = {static_cast<float>(curvature)};
    live.setSurface(surface);
  }

  /// Feeds scans of 50 Hz.
  void feed(int scans) {
    for (int i = 0; i < scans; ++i) {
      scan.header.stamp.fromSec(time += 0.02);
      fsr_pressure_map::PressureMap map;
      live.calibrate(scan, map);
    }
  }

  std::future<std::string> answer() {
    return std::async(std::launch::async, [this] {
      return live.answerMark([this](RestMark) { return live.checkSurface(kPatience); });
    });
  }

  /// The answer to the mark; scans come meanwhile.
  std::string answered() {
    std::future<std::string> pending = answer();
    while (pending.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) feed(1);
    return pending.get();
  }

  /// The answer if `interrupt` is called while the window of scans is being filled.
  template <typename Interrupt>
  std::string interrupted(const Interrupt& interrupt) {
    std::future<std::string> pending = answer();
    for (int i = 0; i < 100; ++i) {  // [ms]; no scan comes, so that the window stays open
      if (pending.wait_for(std::chrono::milliseconds(1)) == std::future_status::ready) break;
    }
    interrupt();
    return pending.get();
  }

  double time = 1000;  // [s]
  fsr_pressure_map::MatrixFrame scan;
  LiveCalibration live{settings()};
};

TEST_F(LiveMarks, AMarkedRestIsComparedOnce) {
  EXPECT_EQ(answered(), "") << "nothing was marked";
  live.markUnloaded();
  EXPECT_EQ(live.health().marked, "doff: being measured");
  const std::string said = answered();
  EXPECT_EQ(said.rfind("doff: the sheet rests as on ", 0), 0u) << said;
  EXPECT_NE(said.find("which agrees with declared"), std::string::npos) << said;
  EXPECT_EQ(live.health().marked, said);
  EXPECT_EQ(live.health().shape.verdict, fsr::calibration::ShapeVerdict::kAgrees);
  EXPECT_TRUE(live.restAgrees());
  EXPECT_EQ(answered(), "") << "the mark is answered";
}

TEST_F(LiveMarks, ATareIsARestToo) {
  std::future<std::string> tare = std::async(std::launch::async, [this] { return live.tare(kPatience); });
  while (tare.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) feed(1);
  EXPECT_EQ(tare.get().rfind("the sheet is tared on surface", 0), 0u);
  const std::string said = answered();
  EXPECT_EQ(said.rfind("tare: the sheet rests as on ", 0), 0u) << said;
  EXPECT_EQ(live.health().shape.verdict, fsr::calibration::ShapeVerdict::kAgrees);
  fs::remove(settings().tare_file);
}

TEST_F(LiveMarks, NothingIsComparedOnAnotherBoard) {
  fsr_pressure_map::MatrixInfo board;
  board.serial = "board-2";
  board.ambient_pressure = kAmbient;
  live.setBoard(board);
  live.markUnloaded();
  EXPECT_TRUE(test_support::holds(answered(), {"board is board-2", "board-1"}));
}

TEST_F(LiveMarks, AMarkedRestFindsAWrongSurface) {
  lieOn(20);
  live.markUnloaded();
  const std::string said = answered();
  EXPECT_NE(said.find("but the surface file says declared"), std::string::npos) << said;
  EXPECT_FALSE(live.restAgrees());
  lieOn(kBend);
  EXPECT_EQ(live.health().marked, "") << "was said of another surface";
}

TEST_F(LiveMarks, NothingIsComparedWhileTheChamberIsNotAtAmbient) {
  live.setChamber(kAmbient + 100e3);
  live.markUnloaded();
  EXPECT_TRUE(test_support::holds(answered(), {"how the sheet lies cannot be told"}));
  EXPECT_EQ(live.health().shape.sentence, "");
  live.setChamber(kAmbient);
  live.markUnloaded();
  EXPECT_NE(answered().find("agrees"), std::string::npos);
}

TEST_F(LiveMarks, AComparisonEndsWhenTheChamberLeavesAmbient) {
  live.setChamber(kAmbient);
  live.markUnloaded();
  EXPECT_EQ(interrupted([this] { live.setChamber(kAmbient + 10e3); }),
            "doff: how the sheet lies cannot be told: the chamber left ambient pressure");
  EXPECT_EQ(live.health().shape.sentence, "");
}

TEST_F(LiveMarks, AComparisonEndsWhenALoadIsMarked) {
  live.markUnloaded();
  const std::string said = interrupted([this] { live.markLoaded(); });
  EXPECT_EQ(said.rfind("doff: how the sheet lies cannot be told: don was marked", 0), 0u) << said;
  EXPECT_EQ(live.health().shape.sentence, "");
}

// Neither by itself in a chamber that stays at ambient, nor by a service.
TEST_F(LiveMarks, NothingIsComparedBetweenDonAndDoff) {
  live.markLoaded();
  lieOn(20);
  live.setChamber(kAmbient);
  feed(60);
  live.compareAtRest();
  EXPECT_EQ(live.health().shape.sentence, "");
  EXPECT_THROW(live.checkSurface(kPatience), fsr::settings::InputError);
  live.markUnloaded();
  EXPECT_NE(answered().find("but the surface file says declared"), std::string::npos);
}

TEST_F(LiveMarks, AnAnswerIsReplacedByThatOfAService) {
  live.setChamber(kAmbient + 100e3);
  live.markUnloaded();
  EXPECT_NE(answered().find("not at ambient"), std::string::npos);
  live.setChamber(kAmbient);
  auto pending = std::async(std::launch::async, [this] { return live.checkSurface(kPatience); });
  while (pending.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) feed(1);
  EXPECT_NE(pending.get().find("agrees"), std::string::npos);
  EXPECT_EQ(live.health().marked, "");
}

}  // namespace
}  // namespace fsr_ros
