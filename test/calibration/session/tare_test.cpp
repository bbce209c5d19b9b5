#include "calibration/stages/session/tare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/allocation_guard.h"
#include "support/holds.h"

namespace fsr::calibration {
namespace {

const matrix::Layout kLayout{{2, 3}};

map::PressureMap restingMap(float pressure) {
  map::PressureMap map;
  map.reset(kLayout);
  map.pressure.assign(6, pressure);
  return map;
}

/// 3 s at 10 Hz of `pressure(i)` on taxel 4, 1 kPa on the others.
TareMeasurement measured(const std::function<float(int)>& pressure, const TareOptions& options = {}) {
  TareMeasurement measurement(kLayout, options);
  for (int i = 0; i < 30; ++i) {
    map::PressureMap map = restingMap(1000.0f);
    map.pressure[4] = pressure(i);
    measurement.add(map, i * 0.1);
  }
  return measurement;
}

std::string refusalOf(const std::function<void()>& action) {
  return test_support::refusal(action, "accepted");
}

Tare someTare() {
  Tare tare;
  tare.calibration = "3f2a";
  tare.surface = "cylinder 7: \"cm\"";
  tare.mount = 2;
  tare.curvature = 100.0 / 7.0;
  tare.date = "2024-05-17T09:30:00Z";
  tare.size = {2, 3};
  tare.offset = {1.5f, -2000.25f, 1.0f / 3.0f, 0.0f, 4.0f, 5.0f};
  return tare;
}

TEST(TareMeasurement, GivesTheMeanOfAFullWindow) {
  TareMeasurement measurement(kLayout, {});
  int scans = 0;
  while (!measurement.add(restingMap(scans % 2 == 0 ? 900.0f : 1100.0f), scans * 0.125)) ++scans;
  EXPECT_EQ(scans, 16);  // 2 s at 8 Hz, the last scan not counted
  EXPECT_FLOAT_EQ(measurement.offset({})[0], (9 * 900.0f + 8 * 1100.0f) / 17);
}

TEST(TareMeasurement, AddsToThePresentTare) {
  const auto measurement = measured([](int) { return -500.0f; });
  const std::vector<float> offset = measurement.offset({0, 10, 20, 30, 40, 50});
  EXPECT_FLOAT_EQ(offset[1], 1010.0f);
  EXPECT_FLOAT_EQ(offset[4], -460.0f);
}

TEST(TareMeasurement, RefusesALoadAboveTheLimit) {
  const auto measurement = measured([](int) { return 31e3f; });
  EXPECT_TRUE(
      test_support::holds(refusalOf([&] { measurement.offset({}); }), {"31 kPa", "30 kPa (~tare_limit)"}));
}

TEST(TareMeasurement, RefusesToExceedTheLimitInSeveralTares) {
  const auto measurement = measured([](int) { return 20e3f; });
  EXPECT_NE(refusalOf([&] { measurement.offset(std::vector<float>(6, 20e3f)); }), "accepted");
}

TEST(TareMeasurement, RefusesAPulsatingLoad) {
  const auto measurement = measured([](int i) { return 8e3f + 6e3f * std::sin(0.8f * float(i)); });
  EXPECT_NE(refusalOf([&] { measurement.offset({}); }).find("column 1 scatters by 4."), std::string::npos);
}

TEST(TareMeasurement, KeepsTheTareOfTaxelsWithoutAReading) {
  const auto measurement = measured([](int) { return NAN; });
  const std::vector<float> offset = measurement.offset({});
  EXPECT_EQ(offset[4], 0.0f);
  EXPECT_EQ(offset[0], 1000.0f);
}

TEST(TareMeasurement, RefusesASheetWithoutReadings) {
  TareMeasurement measurement(kLayout, {});
  for (int i = 0; i < 30; ++i) measurement.add(restingMap(NAN), i * 0.1);
  EXPECT_NE(refusalOf([&] { measurement.offset({}); }), "accepted");
}

TEST(TareMeasurement, StartsAgainIfTimeRunsBackwards) {
  TareMeasurement measurement(kLayout, {});
  for (int i = 0; i < 15; ++i) measurement.add(restingMap(9000.0f), 100 + i * 0.1);
  bool full = false;
  for (int i = 0; i < 25 && !full; ++i) full = measurement.add(restingMap(1000.0f), i * 0.1);
  EXPECT_TRUE(full);
  EXPECT_FLOAT_EQ(measurement.offset({})[0], 1000.0f);
}

TEST(TareMeasurement, AllocatesNothingForAMap) {
  TareMeasurement measurement(kLayout, {});
  const map::PressureMap map = restingMap(1000.0f);
  const test_support::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) measurement.add(map, (i % 50) * 0.1);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Tare, IsValidForOneCalibrationSurfaceAndMount) {
  const Tare tare = someTare();
  const matrix::Surface same{tare.surface, 2, {{14.3, 0, 0}}, {}};
  EXPECT_TRUE(holds(tare, "3f2a", same));
  EXPECT_FALSE(holds(tare, "3f2b", same));
  EXPECT_FALSE(holds(tare, "3f2a", {tare.surface, 3, same.curvature, {}}));
  EXPECT_FALSE(holds(tare, "3f2a", {"flat", 2, same.curvature, {}}));
  EXPECT_FALSE(holds(tare, "3f2a", {tare.surface, 2, {{13.7, 0, 0}}, {}}));
  EXPECT_FALSE(holds(tare, "3f2a", matrix::Surface{}));
}

class TareFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "tare_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
    path = name + "/tare.yaml";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string content() const {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void replaceInFile(const std::string& from, const std::string& to) const {
    std::string text = content();
    ASSERT_NE(text.find(from), std::string::npos);
    text.replace(text.find(from), from.size(), to);
    std::ofstream(path) << text;
  }

  std::string folder;
  std::string path;
};

TEST_F(TareFile, RestoresASavedTare) {
  const Tare tare = someTare();
  saveTare(tare, path);
  const Tare read = loadTare(path);
  EXPECT_EQ(read.calibration, tare.calibration);
  EXPECT_EQ(read.surface, tare.surface);
  EXPECT_EQ(read.mount, tare.mount);
  EXPECT_EQ(read.curvature, tare.curvature);
  EXPECT_EQ(read.date, tare.date);
  EXPECT_EQ(read.size, tare.size);
  EXPECT_EQ(read.offset, tare.offset);
}

TEST_F(TareFile, RefusesUnknownContent) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{{"tare 1", "tare 9"},
                                                                                 {"mount: 2", "mount: -1"},
                                                                                 {"rows: 2", "rows: 3"},
                                                                                 {"date", "dat"},
                                                                                 {"1.5", "inf"}}) {
    saveTare(someTare(), path);
    replaceInFile(from, to);
    EXPECT_THROW(loadTare(path), settings::InputError) << to;
  }
}

TEST_F(TareFile, RefusesACutOrEmptyFile) {
  saveTare(someTare(), path);
  const std::string whole = content();
  for (const std::size_t size : {std::size_t{0}, whole.size() / 2}) {
    std::ofstream(path) << whole.substr(0, size);
    EXPECT_THROW(loadTare(path), settings::InputError) << size << " bytes";
  }
}

}  // namespace
}  // namespace fsr::calibration
