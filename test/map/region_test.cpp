#include "fsr_pressure_map/map/region.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/source_dir.h"

namespace fsr::map {
namespace {

using Mask = std::vector<std::uint8_t>;

std::vector<Region> read(const std::string& yaml) {
  return readRegions(yaml, "regions.yaml", {2, 3});
}

std::string refusal(const std::string& yaml) {
  return test_support::refusal([&] { read(yaml); });
}

TEST(Regions, AreRectanglesOrMasks) {
  const auto regions = read(
      "regions:\n"
      "  - {name: right, columns: [1, 2]}\n"
      "  - {name: corner, rows: [1, 1], columns: [0, 0]}\n"
      "  - name: drawn\n"
      "    mask: |\n"
      "      1.0\n"
      "      011\n"
      "    alarm: {threshold: 120e3, dwell: 2}\n");
  ASSERT_EQ(regions.size(), 4u);
  EXPECT_EQ(regions[0].name, "");
  EXPECT_TRUE(regions[0].mask.empty());
  EXPECT_EQ(regions[1].mask, (Mask{0, 1, 1, 0, 1, 1}));
  EXPECT_EQ(regions[2].mask, (Mask{0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(regions[3].mask, (Mask{1, 0, 0, 0, 1, 1}));
  EXPECT_EQ(regions[3].alarm.threshold, 120e3);
  EXPECT_EQ(regions[3].alarm.dwell, 2);
  EXPECT_FALSE(regions[1].alarm.used());
}

TEST(Regions, IncludeAnAlarmOfTheWholeMatrix) {
  const auto regions = read("alarm: {threshold: 250e3, hysteresis: 20e3}\n");
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].alarm.threshold, 250e3);
  EXPECT_EQ(regions[0].alarm.hysteresis, 20e3);
}

TEST(Regions, HaveAlarmsInTheUnitOfTheFile) {
  const auto regions = read(
      "unit: mmHg\n"
      "alarm: {threshold: 100, hysteresis: 10}\n"
      "regions: [{name: heel, rows: [0, 0], alarm: {threshold: 200}}]\n");
  EXPECT_NEAR(regions[0].alarm.threshold, 13332.2387415, 1e-6);
  EXPECT_NEAR(regions[0].alarm.hysteresis, 1333.22387415, 1e-6);
  EXPECT_NEAR(regions[1].alarm.threshold, 26664.477483, 1e-6);
  EXPECT_EQ(read("unit: kPa\nalarm: {threshold: 100}\n")[0].alarm.threshold, 100e3);
  EXPECT_NE(refusal("unit: psi\n").find("unit"), std::string::npos);
  EXPECT_NE(refusal("unit: mmHg\nalarm: {threshold: 100, hysteresis: 101}\n").find("0 to 100 mmHg"),
            std::string::npos);
}

TEST(Regions, ReadTheShippedExample) {
  const auto regions = readRegionFile(test_support::sourceDir() + "/config/regions/example.yaml", {7, 10});
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_TRUE(regions[1].has(6) && regions[2].has(30) && !regions[2].has(0));
}

TEST(Regions, RefuseRegionsOutsideTheMatrix) {
  EXPECT_NE(refusal("regions: [{name: a, rows: [0, 2]}]"), "");
  EXPECT_NE(refusal("regions: [{name: a, rows: [1, 0]}]").find("two whole numbers"), std::string::npos);
  EXPECT_NE(refusal("regions: [{name: a, mask: \"11\\n11\"}]").find("2 x 3"), std::string::npos);
  EXPECT_TRUE(
      test_support::holds(refusal("regions: [{name: a, mask: \"111111\"}]"), {"one line for each row"}));
  EXPECT_NE(refusal("regions: [{name: a, mask: \"111\\n1x1\"}]"), "");
}

TEST(Regions, RefuseMisspeltKeysAndDuplicateNames) {
  EXPECT_NE(refusal("regions: [{name: a, rows: [0, 1], colums: [0, 1]}]").find("colums"), std::string::npos);
  EXPECT_TRUE(
      test_support::holds(refusal("regions: [{name: a, rows: [0, 1]}, {name: a, rows: [0, 0]}]"), {"twice"}));
  EXPECT_NE(refusal("regions: [{name: a}]").find("neither"), std::string::npos);
  EXPECT_NE(refusal("alarm: {threshold: -5}").find("threshold"), std::string::npos);
}

}  // namespace
}  // namespace fsr::map
