// No decision outside of src/simulation/effects is made by the id of an effect. What is true of an effect
// stands in its EffectInfo.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "simulation/effects/effect_library.h"
#include "support/content_of.h"
#include "support/source_dir.h"

namespace {

namespace fs = std::filesystem;

std::string codeOf(const fs::path& path) {
  const std::string text = test_support::contentOf(path);
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

// Words that are also the name of a topic, a key of a file or a covariate. Elsewhere they would be ids.
const std::set<std::pair<std::string, std::string>> kOtherMeanings = {
    {"hysteresis", "src/map/region.cpp"},
    {"hysteresis", "src/ros/live/alarm_desk.cpp"},
    {"temperature", "src/calibration/file/calibration_hdf5.cpp"},
    {"temperature", "src/dataset/table_columns.cpp"},
    {"temperature", "src/exports/scan_table.cpp"},
    {"temperature", "src/report/calibration_json.cpp"},
    {"temperature", "src/session/day_advice.cpp"},
    {"temperature", "src/simulation/chamber.cpp"},
    {"temperature", "src/simulation/effect_info.cpp"},
};

bool hasOtherMeaning(const std::string& id, const std::string& file) {
  const bool topic = id == "temperature" && file.rfind("src/ros/", 0) == 0;
  return topic || kOtherMeanings.count({id, file}) > 0;
}

TEST(EffectIds, StandOnlyInTheEffectsThemselves) {
  const fs::path source = test_support::sourceDir();
  std::size_t files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source / "src")) {
    const std::string file = entry.path().lexically_relative(source).string();
    const std::string extension = entry.path().extension().string();
    if ((extension != ".cpp" && extension != ".h") || file.rfind("src/simulation/effects/", 0) == 0) continue;
    ++files;
    const std::string code = codeOf(entry.path());
    for (const std::string& id : fsr::simulation::effectIds()) {
      if (hasOtherMeaning(id, file)) continue;
      EXPECT_EQ(code.find('"' + id + '"'), std::string::npos) << file << " names the effect " << id;
    }
  }
  EXPECT_GT(files, 200u);
}

}  // namespace
