#include "rheology/memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace {

using fsr::rheology::PrandtlIshlinskii;

const PrandtlIshlinskii kOperator({0, 1, 2, 4}, {0.4, 0.3, 0.2, 0.1});

/// Drives the operator linearly from turning point to turning point, with `steps` steps to each.
class Drive {
 public:
  explicit Drive(double start) : position_(start), state_(kOperator.stateSize()) {
    kOperator.reset(start, state_.data());
  }
  double to(double target, int steps) {
    double output = 0;
    const double start = position_;
    for (int i = 1; i <= steps; ++i) {
      const double input = i == steps ? target : start + (target - start) * i / steps;
      output = kOperator.step(input, state_.data());
      position_ = input;
    }
    return output;
  }
  const std::vector<double>& state() const { return state_; }

 private:
  double position_;
  std::vector<double> state_;
};

TEST(PlayOperator, IsConstantInsideItsGapAndFollowsAtItsEdge) {
  EXPECT_EQ(fsr::rheology::playStep(0.9, 1.0, 0.0), 0.0);
  EXPECT_EQ(fsr::rheology::playStep(3.0, 1.0, 0.0), 2.0);
  EXPECT_EQ(fsr::rheology::playStep(1.5, 1.0, 2.0), 2.0);
  EXPECT_EQ(fsr::rheology::playStep(-3.0, 1.0, 2.0), -2.0);
}

TEST(PlayOperator, DependsOnTurningPointsOnlyAndNotOnTheRate) {
  Drive slow(0), fast(0);
  for (const double target : {10.0, 2.0, 7.0, -3.0, 4.0}) {
    EXPECT_DOUBLE_EQ(slow.to(target, 1000), fast.to(target, 1));
  }
}

TEST(PlayOperator, WipesOutAnInnerLoopOnceItIsExceeded) {
  Drive direct(0), detour(0);
  direct.to(10, 100);
  detour.to(6, 60);
  detour.to(3, 30);
  detour.to(5, 20);
  detour.to(10, 50);
  EXPECT_EQ(detour.state(), direct.state());
}

TEST(PlayOperator, ClosesMinorLoopsOfOneWidthCongruently) {
  Drive low(0), high(0);
  low.to(10, 10);
  high.to(20, 10);
  const double first_rise = low.to(6, 10), second_rise = high.to(16, 10);
  EXPECT_NEAR(low.to(9, 10) - first_rise, high.to(19, 10) - second_rise, 1e-12);
}

TEST(PlayOperator, ResetForgetsTheHistory) {
  Drive used(0);
  used.to(50, 7);
  std::vector<double> state = used.state();
  kOperator.reset(3, state.data());
  EXPECT_EQ(state, Drive(3).state());
}

TEST(PlayOperator, RefusesNegativeRadiiAndUnequalLengths) {
  EXPECT_THROW(PrandtlIshlinskii({-1.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW(PrandtlIshlinskii({1.0, 2.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW(PrandtlIshlinskii({1.0}, {std::nan("")}), std::invalid_argument);
  EXPECT_THROW(PrandtlIshlinskii({std::numeric_limits<double>::infinity()}, {1.0}), std::invalid_argument);
}

}  // namespace
