#include "fsr_pressure_map/view/heat_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "view/legend.h"
#include "view/taxel_look.h"

namespace fsr::view {
namespace {

map::PressureMap ramp(matrix::MatrixSize size) {
  map::PressureMap map;
  map.reset({size, 0.010, 0.012});
  map.state = map::MapState::kOk;
  for (std::size_t i = 0; i < size.taxels(); ++i) {
    map.pressure[i] = 8e3f * float(i);
    map.deviation[i] = 1e3f * float(i);
  }
  return map;
}

TEST(HeatMap, ShowsEachTaxelInItsColourWithRowZeroOnTop) {
  const map::PressureMap map = ramp({7, 10});
  const HeatMap painter(HeatMapStyle{});
  const Image image = painter.draw(map, {"one", "two"});
  Pixel before{-1, -1};
  for (std::size_t i = 0; i < 70; ++i) {
    const Pixel centre = painter.centre(map.layout, {i}, 2);
    EXPECT_EQ(image.at(centre), PressureScale{}.colour(map.pressure[i])) << i;
    EXPECT_TRUE(i % 10 == 0 ? centre.y > before.y : centre.x > before.x) << i;
    before = centre;
  }
}

TEST(HeatMap, ShowsTheDeviationOnRequest) {
  const map::PressureMap map = ramp({7, 10});
  HeatMapStyle style;
  style.layer = MapLayer::kDeviation;
  style.scale.high = 70e3;
  const HeatMap painter(style);
  EXPECT_EQ(painter.draw(map).at(painter.centre(map.layout, {44}, 0)), style.scale.colour(44e3));
}

TEST(HeatMap, InterpolatesBetweenTaxelsIfSmooth) {
  map::PressureMap map = ramp({1, 2});
  map.pressure = {0, 600e3f};
  HeatMapStyle style;
  style.smooth = true;
  const HeatMap painter(style);
  const Image image = painter.draw(map);
  const Pixel a = painter.centre(map.layout, {0}, 0), b = painter.centre(map.layout, {1}, 0);
  const Colour middle = image.at({(a.x + b.x) / 2, a.y});
  EXPECT_NEAR(middle.green, style.scale.colour(300e3).green, 3);
}

TEST(HeatMap, ColourBarShowsTheWholeScale) {
  const HeatMap painter(HeatMapStyle{});
  const map::PressureMap map = ramp({7, 10});
  const Image image = painter.draw(map);
  const int x = image.width() - 60;  // inside the bar
  const Pixel top = painter.centre(map.layout, {0}, 0), bottom = painter.centre(map.layout, {60}, 0);
  int last = 256;
  for (int y = top.y; y < bottom.y; y += 10) {
    const int green = image.at({x, y}).green;
    EXPECT_LT(green, last + 1) << "at " << y;
    last = green;
  }
}

TEST(HeatMap, MarksUnreliableTaxels) {
  for (const TaxelLook look : markedLooks()) {
    map::PressureMap map = ramp({3, 3});
    if (look == TaxelLook::kNoReading) map.pressure[4] = NAN;
    if (look == TaxelLook::kSaturated) map.flags[4] = map::taxel_flag::kSaturated;
    if (look == TaxelLook::kExtrapolated) map.flags[4] = map::taxel_flag::kReadingExtrapolated;
    EXPECT_EQ(lookOf(map.pressure[4], map.flags[4]), look);
    const HeatMap painter(HeatMapStyle{});
    const Image plain = painter.draw(ramp({3, 3}));
    const Image marked = painter.draw(map);
    EXPECT_NE(plain.bytes(), marked.bytes()) << name(look);
  }
}

// After each start all taxels have this flag: a mark on each would hide the map.
TEST(HeatMap, HasNoMarkForAHistoryThatIsNotSettled) {
  map::PressureMap map = ramp({3, 3});
  map.flags.assign(9, map::taxel_flag::kHistoryShort);
  const HeatMap painter(HeatMapStyle{});
  EXPECT_EQ(painter.draw(map).bytes(), painter.draw(ramp({3, 3})).bytes());
  map.flags[4] = map::taxel_flag::kHistoryShort | map::taxel_flag::kSaturated;
  EXPECT_EQ(lookOf(map.pressure[4], map.flags[4]), TaxelLook::kSaturated);
}

TEST(Legend, SaysHowManyTaxelsAreNotSettledInOneLine) {
  EXPECT_EQ(settlingWord(0) + settlingText(0), "");
  EXPECT_EQ(settlingWord(1), "settling");
  EXPECT_EQ(settlingText(1), "history not settled");
  EXPECT_EQ(settlingText(0.12), "history not settled on 12 % of taxels");
  for (const double share : {1.0 / 4096, 0.12, 1 - 1.0 / 4096}) {
    EXPECT_LE(Image::textWidth(settlingWord(share)), 186) << settlingWord(share);  // width of a line [pixels]
  }
  EXPECT_EQ(settlingWord(1.0 / 4096), "settling: 1 % of taxels");
  EXPECT_EQ(settlingWord(1 - 1.0 / 4096), "settling: 99 % of taxels");
}

TEST(HeatMap, DoesNotMarkTaxelsAtRest) {
  const map::PressureMap plain = ramp({3, 3});
  map::PressureMap at_rest = plain;
  at_rest.flags[4] = map::taxel_flag::kBelowRange;
  at_rest.flags[5] = map::taxel_flag::kBelowRange | map::taxel_flag::kReadingExtrapolated;
  const HeatMap painter(HeatMapStyle{});
  EXPECT_EQ(painter.draw(plain).bytes(), painter.draw(at_rest).bytes());
}

TEST(HeatMap, HasOneSizeForAllMapsOfAMatrix) {
  const HeatMap painter(HeatMapStyle{});
  map::PressureMap dark = ramp({16, 10});
  dark.pressure.assign(160, NAN);
  const Image a = painter.draw(ramp({16, 10}), {"t = 1 s"}), b = painter.draw(dark, {"t = 2 s"});
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
}

TEST(HeatMap, AcceptsEveryMatrixSize) {
  for (const matrix::MatrixSize size : {matrix::MatrixSize{1, 1}, matrix::MatrixSize{1, 64},
                                        matrix::MatrixSize{64, 1}, matrix::MatrixSize{64, 64}}) {
    EXPECT_NO_THROW(HeatMap(HeatMapStyle{}).draw(ramp(size)));
  }
}

TEST(HeatMap, RefusesAMapThatContradictsItself) {
  map::PressureMap map = ramp({3, 3});
  map.flags.pop_back();
  EXPECT_THROW(HeatMap(HeatMapStyle{}).draw(map), settings::InputError);
  EXPECT_THROW(HeatMap(HeatMapStyle{}).draw(map::PressureMap{}), settings::InputError);
}

TEST(Legend, ShowsTheScaleWithItsHighEndOnTop) {
  Legend legend;
  legend.lines = {"one"};
  const Image image = drawLegend(legend);
  int bright = 0, dark = 0;
  for (int y = 0; y < image.height(); ++y) {
    if (image.at({15, y}) == legend.scale.colour(599e3)) bright = y;
    if (image.at({15, y}) == legend.scale.colour(1e3)) dark = y;
  }
  EXPECT_GT(bright, 0);
  EXPECT_GT(dark, bright + 150);
  legend.lines = {std::string(300, 'x')};
  EXPECT_EQ(drawLegend(legend).width(), image.width());
}

TEST(Image, DrawsNothingOutsideItself) {
  Image image(10, 10, {1, 2, 3});
  image.line({-50, -50}, {60, 60}, {9, 9, 9}, 3);
  image.text({-3, 5}, "clipped \xff text", {7, 7, 7});
  image.fill({8, 8}, 100, 100, {5, 5, 5});
  EXPECT_EQ(image.at({9, 9}), (Colour{5, 5, 5}));
  EXPECT_EQ(image.bytes().size(), 300u);
}

TEST(Image, ClipsARowToItsWidth) {
  Image image(10, 10, {1, 2, 3});
  for (const Pixel left : {Pixel{-2, 4}, Pixel{0, -1}, Pixel{0, 10}, Pixel{30, 4}, Pixel{-30, 4}}) {
    image.setRow(left, std::vector<Colour>(4, {1, 1, 9}));
  }
  EXPECT_EQ(image.at({1, 4}), (Colour{1, 1, 9}));
  EXPECT_EQ(image.at({2, 4}), (Colour{1, 2, 3}));
  EXPECT_EQ(image.at({0, 5}), (Colour{1, 2, 3}));
  EXPECT_EQ(image.at({9, 3}), (Colour{1, 2, 3}));
}

}  // namespace
}  // namespace fsr::view
