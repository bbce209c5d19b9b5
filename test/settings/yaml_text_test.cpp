#include "settings/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "settings/settings.h"

namespace {

TEST(YamlText, NumbersAreShortAndReadBackAsTheSameNumber) {
  EXPECT_EQ(fsr::settings::numberText(0.1), "0.1");
  EXPECT_EQ(fsr::settings::numberText(17000), "17000");
  EXPECT_EQ(fsr::settings::numberText(-3e-4), "-0.0003");
  EXPECT_EQ(fsr::settings::numberText(300000), "300000");
  EXPECT_EQ(fsr::settings::numberText(2e-9), "2e-09");
  for (const double value : {1.0 / 3, M_PI * 1e20, 5e-324, 1704099600.25}) {
    EXPECT_EQ(std::strtod(fsr::settings::numberText(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(fsr::settings::numberText(INFINITY), ".inf");
  EXPECT_EQ(fsr::settings::numberText(-INFINITY), "-.inf");
  EXPECT_EQ(fsr::settings::numberText(NAN), ".nan");
}

TEST(YamlText, QuotedTextsReadBackAsTheSameText) {
  const std::string text = "a \"b\" \\ c: # {x}\n'd'";
  const auto settings = fsr::settings::Settings::fromText("t: " + fsr::settings::quotedText(text), "a.yaml");
  EXPECT_EQ(settings.text("t"), text);
}

}  // namespace
