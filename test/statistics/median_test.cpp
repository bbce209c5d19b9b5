#include "statistics/samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using fsr::statistics::upperMedian;

TEST(UpperMedian, IsTheValueInTheMiddleOfAnOddNumber) {
  EXPECT_EQ(upperMedian({7}), 7);
  EXPECT_EQ(upperMedian({3, -1, 2}), 2);
}

TEST(UpperMedian, IsTheLargerOfTheTwoInTheMiddleOfAnEvenNumber) {
  EXPECT_EQ(upperMedian({4, 1}), 4);
  EXPECT_EQ(upperMedian({4, 1, 3, 2}), 3);
}

TEST(UpperMedian, IsWhatTheCallerSaysWhereThereAreNoValues) {
  EXPECT_TRUE(std::isnan(upperMedian({})));
  EXPECT_EQ(upperMedian({}, 0), 0);
}

}  // namespace
