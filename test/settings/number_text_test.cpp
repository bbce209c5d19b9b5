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

TEST(NumberText, OfACellWithoutAValueIsADash) {
  EXPECT_EQ(settings::cellText(NAN, 2), "-");
  EXPECT_EQ(settings::cellText(0.125, 2), settings::fixedText(0.125, 2));
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
