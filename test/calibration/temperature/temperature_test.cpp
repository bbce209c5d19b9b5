// The temperature of the sheet under a live map.

#include "fsr_pressure_map/calibration/temperature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "calibration/stages/temperature/temperature_course.h"
#include "support/allocation_guard.h"

namespace fsr::calibration {
namespace {

TemperatureModel warmModel() {
  return {-0.004, 25, 60, 20, 30, 3};
}

TEST(TemperatureModel, IsAFactor) {
  EXPECT_FALSE(TemperatureModel{}.present());
  EXPECT_DOUBLE_EQ(temperatureFactor(warmModel(), 30), 0.98);
  EXPECT_DOUBLE_EQ(temperatureFactor(warmModel(), -1e9), 2);
  EXPECT_DOUBLE_EQ(temperatureFactor(warmModel(), 1e9), 0.5);
}

TEST(TemperatureState, StartsAtTheFirstTemperatureAndFollows) {
  TemperatureState state(warmModel());
  state.setTemperature(20, 5);
  state.beginScan(0);
  EXPECT_DOUBLE_EQ(state.factor(), 1.02);
  state.beginScan(1000);
  state.setTemperature(30, 5);
  state.beginScan(1000);
  EXPECT_DOUBLE_EQ(state.factor(), 1.02);
  for (int i = 1; i <= 600; ++i) state.beginScan(1000 + 0.1 * i);
  EXPECT_NEAR(state.factor(), 1 - 0.004 * (5 - 10 * std::exp(-1)), 1e-9);
}

TEST(TemperatureState, KeepsTheAnswerOfAnUnknownTemperature) {
  TemperatureState state(warmModel());
  float pressure = 100e3, deviation = 500;
  for (const double temperature : {double(NAN), 30.0, double(NAN)}) {
    state.setTemperature(temperature, 5);
    state.beginScan(1);
    pressure = 100e3, deviation = 500;
    state.correct(1, &pressure, &deviation);
    if (std::isnan(temperature)) {
      EXPECT_EQ(pressure, 100e3f);
      EXPECT_NEAR(deviation, std::hypot(500, 0.004 * 3 * 100e3), 0.1);
    } else {
      EXPECT_NEAR(pressure, 98e3, 0.1);
      EXPECT_NEAR(deviation, 490, 0.1);
    }
  }
}

// Whatever thermometer and clock say, the answer stays between half and twice the pressure.
TEST(TemperatureState, IsBoundedForAnyInput) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double any[] = {double(NAN), kInfinity, -kInfinity, 1e308, -1e308, 0, 25, -300, 85, 1e-300};
  for (const double s : {-1.0, -0.004, 1.0}) {
    TemperatureModel own = warmModel();
    own.sensitivity = s;
    TemperatureState state(own);
    std::mt19937 random(3);
    for (int i = 0; i < 100000; ++i) {
      state.setTemperature(any[random() % 10], 5);
      state.beginScan(random() % 4 == 0 ? any[random() % 10] : 0.01 * i);
      float pressure = 100e3, deviation = 500;
      state.correct(1, &pressure, &deviation);
      ASSERT_TRUE(pressure >= 50e3f && pressure <= 200e3f) << i;
      ASSERT_TRUE(deviation > 0 && std::isfinite(deviation)) << i;
    }
  }
}

TEST(TemperatureState, MakesNoInfinitePressureAndKeepsNoReading) {
  TemperatureModel own = warmModel();
  own.sensitivity = 1;
  TemperatureState state(own);
  state.setTemperature(30, 0);
  state.beginScan(0);
  float pressure[] = {3e38f, -3e38f, std::numeric_limits<float>::quiet_NaN()}, deviation[] = {1, 1, 1};
  state.correct(3, pressure, deviation);
  EXPECT_TRUE(std::isfinite(pressure[0]) && std::isfinite(pressure[1]) && std::isnan(pressure[2]));
}

TEST(TemperatureState, AllocatesNothing) {
  TemperatureState state(warmModel());
  const test_support::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    float pressure = 100e3, deviation = 500;
    state.setTemperature(20 + 0.1 * i, 5);
    state.beginScan(i);
    state.correct(1, &pressure, &deviation);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace fsr::calibration
