#include "settings/number_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

namespace settings = fsr::settings;

TEST(NumberText, HasTheDecimalsAskedFor) {
  EXPECT_EQ(settings::fixedText(1234.56, 1), "1234.6");
  EXPECT_EQ(settings::fixedText(2, 3), "2.000");
  EXPECT_EQ(settings::fixedText(-0.04, 1), "-0.0");
  EXPECT_EQ(settings::fixedText(7.5e9, 0), "7500000000");
}

TEST(NumberText, OfWhatIsNoNumberIsADash) {
  for (const double value : {double(NAN), double(INFINITY), -double(INFINITY)}) {
    EXPECT_EQ(settings::fixedText(value, 2), "-");
    EXPECT_EQ(settings::fixedText(value, 0), "-");
    EXPECT_EQ(settings::roundedText(value), "-");
    EXPECT_EQ(settings::percentText(value), "-");
  }
}

// std::lround() makes -9223372036854775808 of it.
TEST(NumberText, OfALargeNumberIsThatNumber) {
  EXPECT_EQ(settings::fixedText(1e300, 1), "1e+300");
  EXPECT_EQ(settings::fixedText(-2.5e19, 0), "-2.5e+19");
  EXPECT_EQ(settings::percentText(1e18, 0), "1e+20 %");
}

TEST(NumberText, GivesAShareAsPercent) {
  EXPECT_EQ(settings::percentText(0.1234), "12.3 %");
  EXPECT_EQ(settings::percentText(-0.005, 2), "-0.50 %");
}

TEST(NumberText, HasTheSignificantDigitsAskedForAtMost) {
  EXPECT_EQ(settings::roundedText(0.012345, 3), "0.0123");
  EXPECT_EQ(settings::roundedText(2.50), "2.5");
  EXPECT_EQ(settings::roundedText(1e7), "1e+07");
}

TEST(NumberText, GivesMegabytesOfAMillionBytes) {
  EXPECT_EQ(settings::megabytesText(12'340'000), "12.3 MB");
}

}  // namespace
