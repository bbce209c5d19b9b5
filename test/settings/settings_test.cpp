#include "settings/settings.h"

#include <unistd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "support/holds.h"

namespace fsr::settings {
namespace {

std::string messageOf(const std::function<void()>& action) {
  return test_support::refusal([&] { action(); }, "no error");
}

const Range kRate{1.0, 1000.0, "Hz"};

TEST(Settings, ReadsEveryKindOfValue) {
  const auto settings = Settings::fromText(
      "rate: 10\nrows: 7\nloop: yes\nname: flat\nx: [1, 2.5]\nchamber: {peak: 3}", "rig.yaml");
  EXPECT_EQ(settings.number("rate", kRate), 10.0);
  EXPECT_EQ(settings.integer("rows", {1, 64, ""}), 7);
  EXPECT_TRUE(settings.flag("loop", false));
  EXPECT_EQ(settings.choice("name", {"flat", "bent"}), "flat");
  EXPECT_EQ(settings.numbers("x", {}), (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(settings.section("chamber").number("peak", {}), 3.0);
  EXPECT_NO_THROW(settings.refuseUnknown());
}

TEST(Settings, GivesTheFallbackOfAMissingKey) {
  const auto settings = Settings::fromText("rate: 10", "rig.yaml");
  EXPECT_EQ(settings.number("peak", {}, 5.0), 5.0);
  EXPECT_EQ(settings.text("name", "none"), "none");
}

TEST(Settings, NamesFileFieldValueAndRange) {
  const auto settings = Settings::fromText("chamber: {rate: -3}", "rig.yaml");
  EXPECT_TRUE(test_support::holds(messageOf([&] { settings.section("chamber").number("rate", kRate); }),
                                  {"rig.yaml", "chamber.rate", "-3", "1 to 1000 Hz"}));
}

TEST(Settings, NamesAMissingKey) {
  const auto settings = Settings::fromText("rows: 7", "rig.yaml");
  EXPECT_TRUE(test_support::holds(messageOf([&] { settings.number("rate", kRate); }),
                                  {"rig.yaml", "1 to 1000 Hz", "rate is missing"}));
}

TEST(Settings, RefusesATextWhereANumberIsExpected) {
  const auto settings = Settings::fromText("rate: fast\npeak: .nan", "rig.yaml");
  EXPECT_THROW(settings.number("rate", kRate), InputError);
  EXPECT_THROW(settings.number("peak", {}), InputError);
}

TEST(Settings, QuoteOnlyTheBeginningOfAFileOfAnotherKind) {
  EXPECT_LT(messageOf([] { Settings::fromText(std::string(5000, 'a'), "table.csv"); }).size(), 200u);
}

TEST(Settings, RefusesAnUnknownKeyOfANestedSection) {
  const auto settings = Settings::fromText("chamber: {rate: 3, raet: 4}", "rig.yaml");
  settings.section("chamber").number("rate", kRate);
  EXPECT_TRUE(
      test_support::holds(messageOf([&] { settings.refuseUnknown(); }), {"rig.yaml", "chamber.raet"}));
}

TEST(Settings, RefusesAKeyGivenTwice) {
  EXPECT_TRUE(test_support::holds(messageOf([] { Settings::fromText("rate: 1\nrate: 2", "rig.yaml"); }),
                                  {"rig.yaml", "rate is given twice"}));
}

TEST(Settings, RefusesAKeyThatIsNotAText) {
  EXPECT_TRUE(test_support::holds(messageOf([] { Settings::fromText("rate: 1\n? [a, b]\n: 2", "rig.yaml"); }),
                                  {"rig.yaml", "a key is a list of 2"}));
  const auto settings = Settings::fromText("chamber: {~: 1}", "rig.yaml");
  EXPECT_TRUE(test_support::holds(messageOf([&] { settings.section("chamber"); }),
                                  {"rig.yaml", "a key of chamber is empty"}));
}

TEST(Settings, RefusesAFileThatIsNotAYamlMapping) {
  EXPECT_THROW(Settings::fromText("- 1\n- 2", "rig.yaml"), InputError);
  EXPECT_THROW(Settings::fromText("", "rig.yaml"), InputError);
  EXPECT_THROW(Settings::fromText("a: [1, 2", "rig.yaml"), InputError);
  EXPECT_THROW(Settings::fromFile("/nowhere/rig.yaml"), InputError);
  const std::string large = testing::TempDir() + "settings_large_" + std::to_string(::getpid()) + ".yaml";
  std::ofstream(large) << "a: 1\n";
  std::filesystem::resize_file(large, 20 << 20);
  EXPECT_TRUE(test_support::holds(messageOf([&] { Settings::fromFile(large); }), {large, "20 MiB", "2 MiB"}));
  std::filesystem::remove(large);
}

TEST(Settings, NamesTheBadEntryOfAList) {
  const auto settings = Settings::fromText("x: [1, 2000]", "limb.yaml");
  EXPECT_TRUE(test_support::holds(messageOf([&] { settings.numbers("x", kRate); }),
                                  {"limb.yaml", "x[1]", "2000", "1 to 1000 Hz"}));
}

TEST(Range, DescribesItsBounds) {
  EXPECT_EQ((Range{0, 2, "s"}.text()), "0 to 2 s");
  EXPECT_EQ((Range{0, INFINITY, "s"}.text()), "0 s or more");
  EXPECT_EQ((Range{-INFINITY, 2, ""}.text()), "2 or less");
  EXPECT_FALSE((Range{0, 2, "s"}.contains(NAN)));
}

}  // namespace
}  // namespace fsr::settings
