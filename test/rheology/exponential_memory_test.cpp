#include "rheology/memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace {

using fsr::rheology::ExponentialMemory;

// Rounding of a few hundred steps. The formula itself is exact.
constexpr double kRounding = 1e-12;

TEST(ExponentialMemory, RespondsToAStepWithOneMinusExp) {
  const ExponentialMemory memory(20);
  EXPECT_NEAR(memory.step(1, 1, 20, 0), 1 - std::exp(-1.0), kRounding);
  EXPECT_NEAR(memory.step(1, 1, 1e6, 0), 1, kRounding);
}

// import numpy; from scipy.signal import lsim  (SciPy 1.10.1)
// t = numpy.linspace(0, 30, 30001); u = numpy.interp(t, [0, 10, 12, 30], [0, 5, 5, -1])
// lsim(([1], [7, 1]), u, t)[1][-1]  ->  1.0021644164844534
TEST(ExponentialMemory, AgreesWithSciPyOnRampsAndDwells) {
  const ExponentialMemory memory(7);
  double m = memory.step(0, 5, 10, 0);
  m = memory.step(5, 5, 2, m);
  m = memory.step(5, -1, 18, m);
  EXPECT_NEAR(m, 1.0021644164844534, 1e-9);
}

TEST(ExponentialMemory, DoesNotDependOnTheSamplingOfARamp) {
  const ExponentialMemory memory(3);
  const double whole = memory.step(0, 10, 5, 1);
  double m = 1;
  for (int i = 0; i < 500; ++i) m = memory.step(10 * i / 500.0, 10 * (i + 1) / 500.0, 0.01, m);
  EXPECT_NEAR(m, whole, kRounding * 100);
}

TEST(ExponentialMemory, DoesNotChangeAtRestOrWithoutTime) {
  const ExponentialMemory memory(3);
  EXPECT_EQ(memory.step(4, 4, 0.1, 4), 4);
  EXPECT_EQ(memory.step(4, 9, 0, 2), 2);
}

TEST(ExponentialMemory, KeepsItsPrecisionOverShortSteps) {
  const ExponentialMemory memory(1e6);
  // To first order m grows by x dt / tau.
  EXPECT_NEAR(memory.step(1, 1, 1e-6, 0) / 1e-12, 1, 1e-9);
}

TEST(ExponentialMemory, RefusesATimeConstantThatIsNotPositive) {
  for (const double tau : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(ExponentialMemory{tau}, std::invalid_argument);
}

}  // namespace
