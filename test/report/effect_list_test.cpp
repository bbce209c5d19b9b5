#include "report/effect_list.h"

#include <gtest/gtest.h>

#include "simulation/effects/effect_library.h"

namespace {

TEST(EffectList, ListsEveryEffectAndSeparatesThoseThatAGasChamberCannotShow) {
  const std::string text = fsr::report::effectListText();
  const std::size_t listed = text.find("Effects that a gas chamber cannot show");
  ASSERT_NE(listed, std::string::npos);
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    const std::size_t place = text.find("\n" + entry.info.id + ": " + entry.info.summary);
    ASSERT_NE(place, std::string::npos) << entry.info.id;
    EXPECT_EQ(place > listed, entry.make == nullptr) << entry.info.id;
  }
}

TEST(EffectList, GivesUnitsRangesAndNeeds) {
  const std::string text = fsr::report::effectListText();
  EXPECT_NE(
      text.find("delay [s]: d, stamps are late by\n"
                "        strength, usual 0.1, neutral 0, plausible -10 to 10 s, permitted -60 to 60 s\n"),
      std::string::npos);
  EXPECT_NE(text.find("permitted 0 to 1; tried 0, 1\n"), std::string::npos);  // one_sided of hysteresis
  EXPECT_NE(text.find("needs       vented_sheet\n"), std::string::npos);
}

TEST(PortraitJson, HasPressuresInKilopascalAndReadingsInPerCent) {
  fsr::simulation::Portrait portrait;
  portrait.title = "t";
  portrait.loop = {{"a", {620e3}, {0.5}}};
  portrait.size = {1, 2};
  portrait.disc = portrait.disc_change = portrait.gas_change = {0.25, -0.5};
  const std::string json = fsr::report::portraitJson(portrait);
  EXPECT_NE(json.find(R"("loop":[{"label":"a","x":[620.0],"y":[50.0]}])"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("gas_change":[[25.0,-50.0]])"), std::string::npos) << json;
}

}  // namespace
