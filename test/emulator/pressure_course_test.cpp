#include "emulator/operator.h"

#include <gtest/gtest.h>

namespace {

using fsr::emulator::PressureCourse;

TEST(PressureCourse, IsZeroUntilSomethingIsWritten) {
  EXPECT_EQ(PressureCourse().at(-1), 0);
  EXPECT_EQ(PressureCourse().at(1e6), 0);
}

TEST(PressureCourse, IsLinearBetweenItsPointsAndConstantBehindThem) {
  PressureCourse course;
  course.cut(10);
  course.rampTo(100e3, 10e3);
  course.stay(5);
  course.moveTo(50e3, 2);
  EXPECT_EQ(course.at(9), 0);
  EXPECT_DOUBLE_EQ(course.at(15), 50e3);
  EXPECT_DOUBLE_EQ(course.at(22), 100e3);
  EXPECT_DOUBLE_EQ(course.at(26), 75e3);
  EXPECT_DOUBLE_EQ(course.at(100), 50e3);
  EXPECT_DOUBLE_EQ(course.end(), 27);
}

TEST(PressureCourse, KeepsThePastWhenItIsCut) {
  PressureCourse course;
  course.rampTo(100e3, 10e3);
  course.cut(4);
  EXPECT_DOUBLE_EQ(course.at(2), 20e3);
  EXPECT_DOUBLE_EQ(course.at(9), 40e3);
  course.cut(7);  // behind the end
  course.rampTo(0, 10e3);
  EXPECT_DOUBLE_EQ(course.at(6), 40e3);
  EXPECT_DOUBLE_EQ(course.at(9), 20e3);
}

}  // namespace
