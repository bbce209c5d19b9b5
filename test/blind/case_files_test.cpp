#include "blind/case_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "blind/small_case.h"
#include "settings/settings.h"

namespace blind {
namespace {

namespace fs = std::filesystem;

class CaseFiles : public testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::path(testing::TempDir()) / ("blind_key_" + std::to_string(getpid()) + ".yaml");
    spec_ = smallCase("mains_pickup", "swelling", 0.5);
    made_ = makeCase(spec_);
    std::ofstream(path_) << keyText(made_);
  }
  void TearDown() override { fs::remove(path_); }

  fs::path path_;
  CaseSpec spec_;
  BlindCase made_;
};

TEST_F(CaseFiles, TheKeySaysWhatIsHiddenAndWhere) {
  const fsr::settings::Settings key = fsr::settings::Settings::fromFile(path_.string());
  EXPECT_EQ(key.text("truth"), "named");
  const fsr::settings::Settings effect = key.sections("effects").at(0);
  EXPECT_EQ(effect.text("id"), "mains_pickup");
  EXPECT_EQ(effect.text("form"), "swelling");
  EXPECT_NEAR(effect.number("snr", {}), 0.5, 0.02);
  const fsr::settings::Settings where = effect.section("where");
  EXPECT_EQ(where.text("taxels"), "all");
  EXPECT_EQ(where.numbers("pressure", {}).size(), 2u);
  EXPECT_NEAR(key.section("noise").number("rms", {}), made_.noise, 1e-12);
}

TEST_F(CaseFiles, AKeyIsFollowedByTheSameSheetUnderAnotherProtocol) {
  CaseSpec again = specFromKey(path_.string());
  const BlindCase same = makeCase(again);
  EXPECT_NEAR(same.noise, made_.noise, 1e-4 * made_.noise);
  EXPECT_NEAR(same.hidden[0].strength, made_.hidden[0].strength, 1e-9);
  again.then = "minor_loops";
  const BlindCase followed = makeCase(again);
  EXPECT_NEAR(followed.noise, made_.noise, 0.01 * made_.noise);
  EXPECT_NEAR(followed.hidden[0].parameters[0].value, made_.hidden[0].parameters[0].value, 1e-9);
  EXPECT_GT(followed.recordings.front().start_ns, made_.recordings.back().start_ns);
  // Without load, the reading of the taxel is the same.
  EXPECT_NEAR(followed.base[7][0], made_.base[7][0], 1e-6);
}

TEST_F(CaseFiles, NothingHiddenIsSaidInSoManyWords) {
  const std::string key = keyText(makeCase(smallCase("", "")));
  EXPECT_NE(key.find("truth: none"), std::string::npos) << key;
  EXPECT_NE(keyText(makeCase(smallCase("foreign", "rate_gain_bent"))).find("truth: unknown"),
            std::string::npos);
}

}  // namespace
}  // namespace blind
