// docs/effects.md tells of every effect of the library, with its picture.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "simulation/effects/effect_library.h"
#include "support/content_of.h"
#include "support/source_dir.h"

namespace {

TEST(EffectsDocument, TellsOfEveryEffectAndShowsItsPicture) {
  const std::filesystem::path docs = test_support::sourceDir() + "/docs";
  const std::string text = test_support::contentOf(docs / "effects.md");
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    const std::string& id = entry.info.id;
    if (entry.info.kind == fsr::simulation::EffectKind::kBase) continue;
    EXPECT_NE(text.find("`" + id + "`"), std::string::npos) << id;
    if (!entry.make) continue;
    const std::string picture = "images/effects/" + id + ".png";
    EXPECT_NE(text.find(picture), std::string::npos) << id;
    EXPECT_TRUE(std::filesystem::exists(docs / picture)) << id;
    EXPECT_NE(text.find("| " + entry.info.summary + " |"), std::string::npos) << id;
  }
}

}  // namespace
