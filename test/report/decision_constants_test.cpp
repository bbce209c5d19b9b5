// All constants of the decision are printed with every result.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "report/discrepancy_report.h"
#include "support/content_of.h"
#include "support/source_dir.h"

namespace fsr::report {
namespace {

namespace fs = std::filesystem;

// All constants stand in DiscrepancyOptions, below the comment that says so, and in results.json.
TEST(Decision, PrintsItsConstantsAndThereAreAtMostFifteen) {
  const nlohmann::json printed =
      nlohmann::json::parse(discrepancyJson(discrepancy::DiscrepancyReport())).at("options");
  const std::string header = test_support::contentOf(fs::path(test_support::sourceDir()) /
                                                     "include/fsr_pressure_map/discrepancy/discrepancy.h");
  const auto begin = header.find("The constants of the decision");
  ASSERT_NE(begin, std::string::npos);
  const std::string constants = header.substr(begin, header.find("\n};", begin) - begin);
  const std::regex member("\n  (?:double|std::size_t) (\\w+) = ");
  std::size_t number = 0;
  for (std::sregex_iterator at(constants.begin(), constants.end(), member); at != std::sregex_iterator();
       ++at) {
    const std::string name = (*at)[1];
    EXPECT_TRUE(printed.contains(name) || printed.contains(name + "_pa")) << name;
    ++number;
  }
  EXPECT_EQ(printed.size(), number);
  EXPECT_GE(number, 10u);
  EXPECT_LE(number, 15u);
}

}  // namespace
}  // namespace fsr::report
