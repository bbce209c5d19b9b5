// Whatever a test keeps in the temporary folder carries its process in its name. ctest runs the cases of one
// suite side by side, each in a process of its own, and two builds may be tested at once: a common name lets
// one case remove what the other reads.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "support/source_dir.h"

namespace {

namespace fs = std::filesystem;

// The statements of the text that name the temporary folder and neither the process nor mkstemp's pattern.
std::vector<std::string> sharedNames(const std::string& text) {
  static const std::regex folder(R"((TempDir|temp_directory_path)\(\))"), own(R"(getpid\(\)|XXXXXX)");
  std::vector<std::string> statements;
  for (std::sregex_iterator found(text.begin(), text.end(), folder), end; found != end; ++found) {
    const auto at = static_cast<std::size_t>(found->position());
    const std::size_t before = text.rfind(';', at), begin = before == std::string::npos ? 0 : before + 1;
    const std::string statement = text.substr(begin, text.find(';', at) - begin);
    if (!std::regex_search(statement, own)) statements.push_back(statement);
  }
  return statements;
}

TEST(TemporaryFiles, AreKnownByTheirStatement) {
  EXPECT_TRUE(sharedNames("path = TempDir() + std::to_string(::getpid());").empty());
  EXPECT_TRUE(sharedNames("path =\n  temp_directory_path() /\n  \"a_XXXXXX\";").empty());
  EXPECT_EQ(sharedNames("a = ::getpid(); path = TempDir() + \"a\"; b = ::getpid();"),
            std::vector<std::string>{" path = TempDir() + \"a\""});
}

TEST(TemporaryFiles, CarryTheirProcessInTheirName) {
  const fs::path tests = fs::path(test_support::sourceDir()) / "test";
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(tests)) {
    const fs::path& path = entry.path();
    if ((path.extension() != ".cpp" && path.extension() != ".h") || path.parent_path() == tests / "house")
      continue;
    ++files;
    std::ifstream in(path);
    for (const std::string& statement : sharedNames({std::istreambuf_iterator<char>(in), {}})) {
      ADD_FAILURE() << fs::relative(path, tests).string() << " shares a name:" << statement
                    << "\nput ::getpid() into it";
    }
  }
  EXPECT_GT(files, 100);  // the files are really read
}

}  // namespace
