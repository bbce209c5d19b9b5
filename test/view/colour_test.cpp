#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "view/legend.h"

namespace fsr::view {
namespace {

// matplotlib 3.6.3: [tuple(round(c * 255) for c in colormaps["viridis"](i)[:3]) for i in (0, 128, 255)]
TEST(ColourMap, EqualsMatplotlibs) {
  EXPECT_EQ(colourAt(ColourMap::kViridis, 0), (Colour{68, 1, 84}));
  EXPECT_EQ(colourAt(ColourMap::kViridis, 0.5), (Colour{33, 145, 140}));
  EXPECT_EQ(colourAt(ColourMap::kViridis, 1), (Colour{253, 231, 37}));
  EXPECT_EQ(colourAt(ColourMap::kCividis, 0), (Colour{0, 34, 78}));
  EXPECT_EQ(colourAt(ColourMap::kCividis, 0.5), (Colour{125, 124, 120}));
  EXPECT_EQ(colourAt(ColourMap::kCividis, 1), (Colour{254, 232, 56}));
}

TEST(ColourMap, KeepsItsEndColoursOutsideTheScale) {
  EXPECT_EQ(colourAt(ColourMap::kViridis, -3), colourAt(ColourMap::kViridis, 0));
  EXPECT_EQ(colourAt(ColourMap::kViridis, 7), colourAt(ColourMap::kViridis, 1));
  EXPECT_EQ(colourAt(ColourMap::kViridis, NAN), colourAt(ColourMap::kViridis, 0));
}

// CIELAB lightness (D65) of an sRGB colour.
double lightness(Colour colour) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const double y = 0.2126 * linear(colour.red / 255.0) + 0.7152 * linear(colour.green / 255.0) +
                   0.0722 * linear(colour.blue / 255.0);
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

// The order is visible without any hue, in steps of about equal size.
TEST(ColourMap, BecomesLighterInEvenSteps) {
  for (const ColourMap map : {ColourMap::kViridis, ColourMap::kCividis}) {
    const double range = lightness(colourAt(map, 1)) - lightness(colourAt(map, 0));
    for (int i = 1; i <= 16; ++i) {
      const double step = lightness(colourAt(map, i / 16.0)) - lightness(colourAt(map, (i - 1) / 16.0));
      EXPECT_GT(step, 0.6 * range / 16);
      EXPECT_LT(step, 1.5 * range / 16);
    }
  }
}

TEST(ColourMap, IsChosenByName) {
  for (const std::string& name : colourMapNames()) EXPECT_NO_THROW(colourMapOf(name));
  EXPECT_THROW(colourMapOf("jet"), settings::InputError);
}

std::string labels(const PressureScale& scale, int most) {
  std::string text;
  for (const Tick& tick : ticks(scale, most)) text += tick.label + " ";
  return text;
}

TEST(PressureScale, TicksAreRoundInTheDisplayedUnit) {
  EXPECT_EQ(labels({0, 600e3, PressureUnit::kKilopascal, {}}, 7), "0 100 200 300 400 500 600 ");
  EXPECT_EQ(labels({0, 2500, PressureUnit::kKilopascal, {}}, 7), "0.0 0.5 1.0 1.5 2.0 2.5 ");
  EXPECT_EQ(labels({-50e3, 120e3, PressureUnit::kKilopascal, {}}, 5), "-50 0 50 100 ");
  EXPECT_EQ(labels({0, 40e3, PressureUnit::kMillimetreOfMercury, {}}, 5), "0 100 200 300 ");
}

TEST(PressureScale, WritesPressuresWithTheirUnit) {
  EXPECT_EQ(pressureText(312.4e3, PressureUnit::kKilopascal), "312 kPa");
  EXPECT_EQ(pressureText(9.94e3, PressureUnit::kKilopascal), "9.9 kPa");
  EXPECT_EQ(pressureText(-20, PressureUnit::kKilopascal), "0.0 kPa");
  EXPECT_EQ(pressureText(13332.2387415, PressureUnit::kMillimetreOfMercury), "100 mmHg");
  EXPECT_EQ(pressureText(NAN, PressureUnit::kKilopascal), "-");
  EXPECT_EQ(limitText(500e3, PressureUnit::kKilopascal, true), ">= 500 kPa");
  EXPECT_EQ(limitText(500e3, PressureUnit::kKilopascal, false), "500 kPa");
  EXPECT_EQ(limitText(NAN, PressureUnit::kKilopascal, true), "-");
}

TEST(PressureScale, RefusesAnEmptyRange) {
  EXPECT_THROW(requireSound(PressureScale{5, 5, {}, {}}), settings::InputError);
  EXPECT_THROW(requireSound(PressureScale{0, NAN, {}, {}}), settings::InputError);
}

TEST(AutoRange, RisesAtOnceToARoundValue) {
  AutoRange range(10e3, 5);
  EXPECT_DOUBLE_EQ(range.update(0, 3e3), 10e3);
  EXPECT_DOUBLE_EQ(range.update(0.1, 130e3), 200e3);
  EXPECT_DOUBLE_EQ(range.update(0.2, NAN), 200e3);
}

TEST(AutoRange, DoesNotFlickerUnderAChangingPeak) {
  AutoRange range(10e3, 5);
  range.update(0, 190e3);
  for (int i = 1; i < 200; ++i) {
    EXPECT_DOUBLE_EQ(range.update(0.1 * i, i % 20 == 0 ? 195e3 : 20e3), 200e3);
  }
}

TEST(AutoRange, StepsDownAfterPeaksStayedLow) {
  AutoRange range(10e3, 5);
  range.update(0, 190e3);
  EXPECT_DOUBLE_EQ(range.update(1, 20e3), 200e3);
  EXPECT_DOUBLE_EQ(range.update(5.9, 20e3), 200e3);
  EXPECT_DOUBLE_EQ(range.update(6.0, 20e3), 100e3);
  EXPECT_DOUBLE_EQ(range.update(6.1, 20e3), 100e3);  // the wait starts again
  EXPECT_DOUBLE_EQ(range.update(0.5, 20e3), 100e3);  // a looped bag
}

}  // namespace
}  // namespace fsr::view
