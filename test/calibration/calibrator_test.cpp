#include "fsr_pressure_map/calibration/calibrator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/small_sheet.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/allocation_guard.h"
#include "support/small_tables.h"

namespace fsr::calibration {
namespace {

using test_support::knownDeviation;
using test_support::knownPressure;
using test_support::smallTables;
namespace flag = map::taxel_flag;

const std::vector<double> kCurvatures = {0.0, 10.0, 20.0};

matrix::Surface bentEach(const std::vector<double>& curvatures) {
  matrix::Surface surface{"limb", 1, {}, {}};
  for (const double curvature : curvatures) surface.curvature.push_back({curvature, 0, 0});
  return surface;
}

class CalibratorTest : public testing::Test {
 protected:
  explicit CalibratorTest(const CalibratorOptions& options = {})
      : calibrator(smallTables(kSize, kCurvatures), {kSize, 0.010, 0.012}, options),
        counts(kSize.taxels(), 500) {}

  const map::PressureMap& run(double time = 0) {
    calibrator.calibrate({kSize, kFullScale, counts.data(), counts.size()}, time, map);
    return map;
  }
  std::uint16_t flagsOf(std::size_t taxel) { return map.flags[taxel]; }

  Calibrator calibrator;
  std::vector<std::uint16_t> counts;
  map::PressureMap map;
};

TEST_F(CalibratorTest, GivesTheValuesOfTheTablesExactly) {
  calibrator.setSurface(bent(10), 0);
  for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) counts[taxel] = std::uint16_t(100 + 50 * taxel);
  run();
  EXPECT_EQ(map.state, map::MapState::kOk);
  EXPECT_EQ(map.layout.size, kSize);
  EXPECT_EQ(map.layout.pitch_y, 0.012);
  for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
    EXPECT_EQ(map.pressure[taxel], knownPressure(taxel, 1, counts[taxel]));
    EXPECT_EQ(map.deviation[taxel], knownDeviation(taxel, 1, counts[taxel]));
    EXPECT_EQ(map.flags[taxel], 0);
  }
}

TEST(Calibrator, GivesTheValuesOfTheTablesForAnyNumberOfTaxels) {
  for (std::uint16_t columns = 1; columns <= 9; ++columns) {
    const matrix::MatrixSize size{1, columns};
    Calibrator calibrator(smallTables(size, {0.0}), {size});
    calibrator.setSurface(bent(0), 0);
    std::vector<std::uint16_t> counts;
    for (std::uint16_t i = 0; i < columns; ++i) counts.push_back(static_cast<std::uint16_t>(100 + 50 * i));
    map::PressureMap map;
    calibrator.calibrate({size, kFullScale, counts.data(), counts.size()}, 0, map);
    for (std::size_t i = 0; i < columns; ++i) {
      EXPECT_EQ(map.pressure[i], knownPressure(i, 0, counts[i])) << i << " of " << columns;
      EXPECT_EQ(map.deviation[i], knownDeviation(i, 0, counts[i])) << i << " of " << columns;
    }
  }
}

TEST_F(CalibratorTest, FlagsCodesOutsideTheRangeOfTraining) {
  calibrator.setSurface(bent(0), 0);
  counts = {0, 19, 20, 500, 928, 929, 1022, 1023, 2000, 500, 500, 500};
  run();
  EXPECT_EQ(flagsOf(0), flag::kBelowRange | flag::kReadingExtrapolated);
  EXPECT_EQ(flagsOf(1), flag::kBelowRange | flag::kReadingExtrapolated);
  EXPECT_EQ(flagsOf(2), 0);  // the lowest code of training
  EXPECT_EQ(flagsOf(4), 0);  // and the highest
  EXPECT_EQ(flagsOf(5), flag::kReadingExtrapolated);
  EXPECT_EQ(flagsOf(6), flag::kReadingExtrapolated);
  EXPECT_EQ(flagsOf(7), flag::kReadingExtrapolated | flag::kSaturated);
  EXPECT_EQ(flagsOf(8), flag::kReadingExtrapolated | flag::kSaturated);  // a code above full scale
  EXPECT_EQ(map.pressure[8], knownPressure(8, 0, kFullScale));
}

TEST_F(CalibratorTest, ChoosesTheNearestClassForEachTaxel) {
  calibrator.setSurface(bentEach({0, 10, 20, 0.4, 9.6, 19.7, 4, 6, 14, 16, 0, 0}), 0);
  run();
  const std::vector<std::size_t> expected = {0, 1, 2, 0, 1, 2, 0, 1, 1, 2, 0, 0};
  for (std::size_t taxel = 0; taxel < expected.size(); ++taxel) {
    EXPECT_EQ(map.pressure[taxel], knownPressure(taxel, expected[taxel], 500)) << taxel;
  }
  EXPECT_EQ(flagsOf(3), 0);  // within the tolerance of 0.5 1/m
  EXPECT_EQ(flagsOf(6), flag::kBetweenClasses);
  EXPECT_EQ(flagsOf(9), flag::kBetweenClasses);
}

TEST_F(CalibratorTest, FlagsACurvatureOutsideTheRangeOfTraining) {
  calibrator.setSurface(bentEach({-20, -0.6, -0.4, 20.4, 20.6, 50, 0, 0, 0, 0, 0, 0}), 0);
  run();
  for (const std::size_t taxel : {0, 1, 4, 5}) EXPECT_EQ(flagsOf(taxel), flag::kCurvatureExtrapolated);
  for (const std::size_t taxel : {2, 3, 6}) EXPECT_EQ(flagsOf(taxel), 0);
  EXPECT_EQ(map.pressure[0], knownPressure(0, 0, 500));  // the nearest class, not the one of opposite sign
}

// The peak of the flat surface was half that of the bent one. Between them, readings above it are too low.
TEST(Calibrator, FlagsAReadingAboveThePeakOfEitherNeighbour) {
  compensation::CurvatureTables tables = smallTables(kSize, {0.0, 10.0});
  tables.rule.blend = compensation::BlendRule::kInterpolate;
  tables.rule.unseen = {{0}, {0}};
  for (std::size_t taxel = 0; taxel < kSize.taxels(); ++taxel) {
    regression::CodeTable& flat = tables.tables[2 * taxel];
    flat.highest = 400;
    for (std::size_t code = 400; code <= kFullScale; ++code) flat.pressure[code] = flat.pressure[400];
  }
  Calibrator calibrator(tables, {kSize, 0.010, 0.012});
  map::PressureMap map;
  const auto at = [&](std::uint16_t code, double curvature) {
    const std::vector<std::uint16_t> counts(kSize.taxels(), code);
    calibrator.setSurface(bent(curvature), 0);
    calibrator.calibrate({kSize, kFullScale, counts.data(), counts.size()}, 0, map);
  };
  at(300, 6);  // nearer to the bent surface
  EXPECT_EQ(map.flags[0], flag::kBetweenClasses);
  at(800, 6);
  EXPECT_EQ(map.flags[0], flag::kBetweenClasses | flag::kReadingExtrapolated);
  EXPECT_TRUE(map::isLowerLimit(map.flags[0]));
  const double error = knownPressure(0, 0, 800) + 6.0 - double(map.pressure[0]);
  EXPECT_GT(error, 15e3);
  EXPECT_GT(double(map.deviation[0]), 0.9 * error);
  at(800, 10);
  EXPECT_EQ(map.flags[0], 0);
}

TEST(Calibrator, DoesNotKnowTheDeviationOnAnotherSurfaceThanItsOnlyOne) {
  Calibrator calibrator(smallTables(kSize, {0.0}), {kSize, 0.010, 0.012});
  const std::vector<std::uint16_t> counts(kSize.taxels(), 500);
  map::PressureMap map;
  calibrator.setSurface(bent(20), 0);
  calibrator.calibrate({kSize, kFullScale, counts.data(), counts.size()}, 0, map);
  EXPECT_EQ(map.flags[0], flag::kCurvatureExtrapolated);
  EXPECT_FALSE(std::isnan(map.pressure[0]));
  EXPECT_TRUE(std::isnan(map.deviation[0]));
  calibrator.setSurface(bent(0), 0);
  calibrator.calibrate({kSize, kFullScale, counts.data(), counts.size()}, 0, map);
  EXPECT_EQ(map.deviation[0], knownDeviation(0, 0, 500));
}

TEST_F(CalibratorTest, UsesThePrincipalCurvatureOfTwoPlanes) {
  calibrator.setSurface({"saddle", 1, {{6, 6, 4}}, {}}, 0);  // principal curvatures 2 and 10
  EXPECT_EQ(run().pressure[0], knownPressure(0, 1, 500));
}

TEST_F(CalibratorTest, SwitchesClassWithHysteresisOnOneSurface) {
  calibrator.setSurface(bent(4.9), 0);
  EXPECT_EQ(calibrator.choices()[0].curvature_class, 0);
  calibrator.setSurface(bent(5.2), 0);  // class 1 is nearer by 0.4 1/m: not enough
  EXPECT_EQ(calibrator.choices()[0].curvature_class, 0);
  calibrator.setSurface(bent(5.3), 0);  // by 0.6 1/m
  EXPECT_EQ(calibrator.choices()[0].curvature_class, 1);
  calibrator.setSurface(bent(4.8), 0);
  EXPECT_EQ(calibrator.choices()[0].curvature_class, 1);
}

TEST_F(CalibratorTest, ForgetsHysteresisOnAnotherSurfaceOrMount) {
  calibrator.setSurface(bent(4.9), 0);
  calibrator.setSurface(bent(5.2, "other"), 0);
  EXPECT_EQ(calibrator.choices()[0].curvature_class, 1);
  calibrator.setSurface(bent(4.9, "other", 2), 0);
  EXPECT_EQ(calibrator.choices()[0].curvature_class, 0);
}

TEST_F(CalibratorTest, UsesTheFlattestClassIfCurvatureIsUnknown) {
  EXPECT_EQ(run().state, map::MapState::kCurvatureUnknown);
  EXPECT_EQ(map.pressure[3], knownPressure(3, 0, 500));
  calibrator.setSurface(bent(20), 0);
  EXPECT_EQ(run().state, map::MapState::kOk);
  calibrator.setSurface({}, 0);
  EXPECT_EQ(run().state, map::MapState::kCurvatureUnknown);
  EXPECT_EQ(map.pressure[3], knownPressure(3, 0, 500));
}

TEST_F(CalibratorTest, RefusesASurfaceMaskOrTareOfAnotherMatrix) {
  EXPECT_THROW(calibrator.setSurface(bentEach({1, 2, 3}), 0), settings::InputError);
  EXPECT_THROW(calibrator.setMask({1, 0}), settings::InputError);
  EXPECT_THROW(calibrator.setTare({1.0f}), settings::InputError);
  EXPECT_EQ(run().state, map::MapState::kCurvatureUnknown);  // nothing changed
  EXPECT_EQ(flagsOf(0), 0);
}

TEST_F(CalibratorTest, ReportsAScanOfAnotherSize) {
  const std::vector<std::uint16_t> many(16, 500);
  calibrator.calibrate({{4, 4}, kFullScale, many.data(), many.size()}, 0, map);
  EXPECT_EQ(map.state, map::MapState::kSizeMismatch);
  ASSERT_EQ(map.pressure.size(), 16u);
  for (const float pressure : map.pressure) EXPECT_TRUE(std::isnan(pressure));
  EXPECT_EQ(run().state, map::MapState::kCurvatureUnknown);  // and continues with the next good scan
  EXPECT_EQ(map.pressure.size(), 12u);
}

TEST_F(CalibratorTest, ReportsAnotherFullScale) {
  calibrator.calibrate({kSize, 4095, counts.data(), counts.size()}, 0, map);
  EXPECT_EQ(map.state, map::MapState::kSizeMismatch);
  EXPECT_TRUE(std::isnan(map.pressure[0]));
}

TEST_F(CalibratorTest, AllocatesNothingForAnInconsistentScan) {
  calibrator.calibrate({{64, 64}, kFullScale, counts.data(), counts.size()}, 0, map);
  EXPECT_EQ(map.state, map::MapState::kSizeMismatch);
  EXPECT_TRUE(map.pressure.empty());
}

TEST_F(CalibratorTest, ReportsAnotherBoard) {
  calibrator.setSurface(bent(10), 0);
  calibrator.setWrongSensor(true);
  EXPECT_EQ(run().state, map::MapState::kWrongSensor);
  EXPECT_EQ(map.pressure[0], knownPressure(0, 1, 500));
}

TEST_F(CalibratorTest, FlagsATemperatureOutsideTheRangeOfTraining) {
  calibrator.setSurface(bent(10), 0);
  const auto flagged = [&](double temperature, double low, double high) {
    calibrator.setTemperature(temperature, low, high);
    run();
    return flagsOf(0) == flag::kTemperatureExtrapolated && flagsOf(11) == flag::kTemperatureExtrapolated;
  };
  EXPECT_TRUE(flagged(40, 22, 23));
  EXPECT_TRUE(flagged(16.9, 22, 23));
  EXPECT_FALSE(flagged(28, 22, 23));  // within the margin of 5 K
  EXPECT_EQ(flagsOf(0), 0);
  EXPECT_FALSE(flagged(40, NAN, NAN));  // training recorded no temperature
  EXPECT_FALSE(flagged(NAN, 22, 23));
}

TEST_F(CalibratorTest, AMaskedTaxelHasNoReading) {
  std::vector<std::uint8_t> mask(12, 0);
  mask[5] = 1;
  calibrator.setMask(mask);
  run();
  EXPECT_TRUE(std::isnan(map.pressure[5]));
  EXPECT_TRUE(std::isnan(map.deviation[5]));
  EXPECT_EQ(flagsOf(5), flag::kMasked);
  EXPECT_FALSE(std::isnan(map.pressure[6]));
  calibrator.setMask({});
  EXPECT_FALSE(std::isnan(run().pressure[5]));
}

TEST_F(CalibratorTest, SubtractsATareAndFlagsIt) {
  calibrator.setTare(std::vector<float>(12, 250.0f));
  run();
  EXPECT_EQ(map.pressure[7], knownPressure(7, 0, 500) - 250.0f);
  EXPECT_EQ(flagsOf(7), flag::kTared);
  calibrator.setTare({});
  EXPECT_EQ(run().pressure[7], knownPressure(7, 0, 500));
  EXPECT_EQ(flagsOf(7), 0);
}

class BadTaxels : public CalibratorTest {
 protected:
  explicit BadTaxels(bool fill = false) : CalibratorTest(withFill(fill)) {}

  static CalibratorOptions withFill(bool fill) {
    CalibratorOptions options;
    options.fill_bad_taxels = fill;
    return options;
  }
  /// Half a minute at 10 Hz in which all taxels but taxel 5 change.
  void keepTaxel5At(std::uint16_t code) {
    for (int i = 0; i < 300; ++i) {
      counts.assign(counts.size(), std::uint16_t(400 + 300 * std::sin(i * 0.1)));
      counts[5] = code;
      run(i * 0.1);
    }
  }
};

TEST_F(BadTaxels, ADeadTaxelHasNoReading) {
  keepTaxel5At(0);
  EXPECT_TRUE(std::isnan(map.pressure[5]));
  EXPECT_EQ(flagsOf(5), flag::kDead | flag::kBelowRange | flag::kReadingExtrapolated);
  EXPECT_EQ(flagsOf(6), 0);
}

TEST_F(BadTaxels, AStuckTaxelHasNoReading) {
  keepTaxel5At(123);
  EXPECT_TRUE(std::isnan(map.pressure[5]));
  EXPECT_EQ(flagsOf(5), flag::kStuck);
}

class FilledTaxels : public BadTaxels {
 protected:
  FilledTaxels() : BadTaxels(true) {}
};

TEST_F(FilledTaxels, AStuckTaxelGetsTheMeanOfItsNeighbours) {
  keepTaxel5At(123);
  EXPECT_EQ(flagsOf(5), flag::kStuck | flag::kFilled);
  EXPECT_NEAR(map.pressure[5], knownPressure(5, 0, counts[0]), 0.05);  // tables differ by taxel / 128 Pa
  EXPECT_GT(map.deviation[5], 1000.0f);
}

TEST_F(FilledTaxels, AMaskedTaxelIsNeverFilled) {
  std::vector<std::uint8_t> mask(12, 0);
  mask[5] = 1;
  calibrator.setMask(mask);
  keepTaxel5At(123);
  EXPECT_TRUE(std::isnan(map.pressure[5]));
  EXPECT_EQ(flagsOf(5), flag::kStuck | flag::kMasked);
}

class CurvatureTimeout : public CalibratorTest {
 protected:
  CurvatureTimeout() : CalibratorTest(withTimeout(3.0)) {}
  static CalibratorOptions withTimeout(double timeout) {
    CalibratorOptions options;
    options.curvature_timeout = timeout;
    return options;
  }
};

TEST_F(CurvatureTimeout, AnOldSurfaceIsStaleButStillUsed) {
  calibrator.setSurface(bent(20), 100.0);
  EXPECT_EQ(run(103.0).state, map::MapState::kOk);
  EXPECT_EQ(run(103.1).state, map::MapState::kCurvatureStale);
  EXPECT_EQ(map.pressure[0], knownPressure(0, 2, 500));
  calibrator.setSurface(bent(20), 103.0);
  EXPECT_EQ(run(103.2).state, map::MapState::kOk);
}

TEST_F(CurvatureTimeout, TheAgeStartsAgainIfTimeRunsBackwards) {
  calibrator.setSurface(bent(20), 100.0);
  run(100.0);
  EXPECT_EQ(run(50.0).state, map::MapState::kOk);
  EXPECT_EQ(run(53.1).state, map::MapState::kCurvatureStale);  // the looped bag has no surface
}

TEST_F(CalibratorTest, NoTimeoutMeansNeverStale) {
  calibrator.setSurface(bent(20), 0.0);
  EXPECT_EQ(run(1e6).state, map::MapState::kOk);
}

TEST(Calibrator, ABaselineNeedsNoCurvature) {
  compensation::CurvatureTables tables = smallTables(kSize, {0.0});
  tables.scheme = compensation::Scheme::kBaseline;
  tables.curvature_high = 20.0;
  Calibrator calibrator(tables, {kSize});
  const std::vector<std::uint16_t> counts(12, 500);
  map::PressureMap map;
  calibrator.calibrate({kSize, kFullScale, counts.data(), 12}, 0, map);
  EXPECT_EQ(map.state, map::MapState::kOk);
  calibrator.setSurface(bent(12.5), 0);
  calibrator.calibrate({kSize, kFullScale, counts.data(), 12}, 0, map);
  EXPECT_EQ(map.flags[0], 0);  // there are no classes
}

TEST(Calibrator, AClassMayHaveACurvatureForEachTaxel) {
  compensation::CurvatureTables tables = smallTables(kSize, {0.0, 10.0});
  tables.classes[1].curvature.assign(12, 10.0);
  tables.classes[1].curvature[4] = 30.0;
  tables.curvature_high = 30.0;
  Calibrator calibrator(tables, {kSize});
  calibrator.setSurface(bent(12), 0);
  EXPECT_EQ(calibrator.choices()[3].curvature_class, 1);
  EXPECT_EQ(calibrator.choices()[4].curvature_class, 0);
}

TEST(Calibrator, ATaxelWithoutAModelIsMasked) {
  compensation::CurvatureTables tables = smallTables(kSize, {0.0});
  tables.tables[5].pressure.assign(kFullScale + 1u, NAN);
  tables.tables[5].deviation.assign(kFullScale + 1u, NAN);
  Calibrator calibrator(tables, {kSize});
  const std::vector<std::uint16_t> counts(12, 500);
  map::PressureMap map;
  calibrator.calibrate({kSize, kFullScale, counts.data(), 12}, 0, map);
  EXPECT_TRUE(std::isnan(map.pressure[5]));
  EXPECT_EQ(map.flags[5], flag::kMasked);
  EXPECT_EQ(map.flags[6], 0);
}

const std::vector<double> kPapersCurvatures = {0, 7.69, 9.09, 11.1, 14.3, 20};

TEST(Calibrator, AFineConverterIsInterpolatedBetweenEntries) {
  constexpr std::uint16_t kFine = 65535;
  constexpr matrix::MatrixSize kPair{1, 2};
  compensation::CurvatureTables tables = smallTables(kPair, {0.0}, kFine);
  for (regression::CodeTable& table : tables.tables) {
    for (std::size_t code = 0; code <= kFine; ++code) {
      table.pressure[code] = static_cast<float>(620e3 * std::pow(static_cast<double>(code) / kFine, 1.5));
    }
  }
  Calibrator calibrator(tables, {kPair});
  calibrator.setSurface(bent(0), 0);
  map::PressureMap map;
  double worst = 0;
  for (unsigned code = 0; code <= kFine; ++code) {
    const std::vector<std::uint16_t> counts(2, static_cast<std::uint16_t>(code));
    calibrator.calibrate({kPair, kFine, counts.data(), counts.size()}, 0, map);
    worst = std::max(worst, std::abs(double{map.pressure[1]} - tables.table(1, 0).pressure[code]));
    if (code % 4 == 0) {
      ASSERT_EQ(map.pressure[1], tables.table(1, 0).pressure[code]) << code;
    }
    ASSERT_NEAR(map.deviation[1], tables.table(1, 0).deviation[code], 0.1);
  }
  EXPECT_LT(worst, 0.2);  // [Pa]; one count at full scale is 14
}

TEST(Calibrator, TakesLittleMemory) {
  constexpr matrix::MatrixSize kPair{1, 2};
  const auto bytesOf = [&](std::uint16_t full_scale, std::size_t taxels) {
    const Calibrator calibrator(smallTables(kPair, kPapersCurvatures, full_scale), {kPair});
    return calibrator.bytes() / kPair.taxels() * taxels;
  };
  EXPECT_LT(bytesOf(4095, 70), 25e6);
  EXPECT_LT(bytesOf(65535, 160), 200e6);
}

TEST(Calibrator, RefusesIncompleteTables) {
  compensation::CurvatureTables missing = smallTables(kSize, {0.0});
  missing.tables.pop_back();
  EXPECT_THROW(Calibrator(missing, {kSize}), settings::InputError);
  compensation::CurvatureTables cut = smallTables(kSize, {0.0});
  cut.tables[3].pressure.pop_back();
  EXPECT_THROW(Calibrator(cut, {kSize}), settings::InputError);
  compensation::CurvatureTables infinite = smallTables(kSize, {0.0});
  infinite.tables[3].deviation[9] = INFINITY;
  EXPECT_THROW(Calibrator(infinite, {kSize}), settings::InputError);
  compensation::CurvatureTables holed = smallTables(kSize, {0.0});
  holed.tables[3].pressure[9] = NAN;
  EXPECT_THROW(Calibrator(holed, {kSize}), settings::InputError);
  EXPECT_THROW(Calibrator(smallTables(kSize, {0.0}), {{4, 4}}), settings::InputError);
}

TEST_F(FilledTaxels, AScanAllocatesNothing) {
  calibrator.setSurface(bent(10), 0);
  run();  // the map gets its size
  const test_support::AllocationGuard guard;
  keepTaxel5At(123);
  EXPECT_EQ(flagsOf(5), flag::kStuck | flag::kFilled);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace fsr::calibration
