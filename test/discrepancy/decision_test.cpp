// The decision knows no effect by its id.
#include "discrepancy/decide/decision.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "simulation/effects/effect_library.h"
#include "support/content_of.h"
#include "support/source_dir.h"

namespace fsr::discrepancy {
namespace {

namespace fs = std::filesystem;

// The texts in quotation marks, without comments.
std::vector<std::string> stringsOf(const std::string& source) {
  const std::string code = std::regex_replace(source, std::regex("//[^\n]*"), "");
  const std::regex quoted("\"[^\"\n]*\"");
  std::vector<std::string> strings;
  for (std::sregex_iterator at(code.begin(), code.end(), quoted); at != std::sregex_iterator(); ++at)
    strings.push_back(at->str());
  return strings;
}

// Not even within a sentence: what is told of an effect comes from its EffectInfo.
TEST(Decision, NamesNoEffect) {
  std::size_t files = 0, strings = 0;
  for (const char* folder : {"decide", "prove"}) {
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(test_support::sourceDir()) / "src/discrepancy" / folder)) {
      ++files;
      for (const std::string& text : stringsOf(test_support::contentOf(entry.path()))) {
        ++strings;
        for (const std::string& id : simulation::effectIds()) {
          EXPECT_FALSE(std::regex_search(text, std::regex("\\b" + id + "\\b")))
              << entry.path().filename() << " names the effect " << id << " in " << text;
        }
      }
    }
  }
  EXPECT_GT(files, 20u);
  EXPECT_GT(strings, 100u);
}

}  // namespace
}  // namespace fsr::discrepancy
