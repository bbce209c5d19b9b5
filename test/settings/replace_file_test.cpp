#include "settings/replace_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_size_limit.h"

namespace fsr::settings {
namespace {

namespace fs = std::filesystem;

class ReplaceFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "replace_file_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }

  static std::string contentOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  fs::path folder;
};

TEST_F(ReplaceFile, LeavesOnlyTheNewContentAtThePath) {
  replaceFile(folder / "a.yaml", "long old content");
  replaceFile(folder / "a.yaml", std::string("new\0one", 7));
  EXPECT_EQ(contentOf(folder / "a.yaml"), std::string("new\0one", 7));
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, NamesThePathWhereItsFolderIsMissing) {
  try {
    replaceFile("/nowhere/a.yaml", "x");
    FAIL() << "written";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "/nowhere/a.yaml: cannot be written (No such file or directory); give a path in a directory "
                 "that exists and may be written to");
  }
}

TEST_F(ReplaceFile, KeepsOnlyTheOldContentWhereTheDiskIsFull) {
  replaceFile(folder / "a.yaml", "old");
  const test_support::FileSizeLimit disk(1000);
  EXPECT_THROW(replaceFile(folder / "a.yaml", std::string(2000, 'x')), InputError);
  EXPECT_EQ(contentOf(folder / "a.yaml"), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, RemovesTheTemporaryFileWhenTheRenameFails) {
  fs::create_directory(folder / "a.yaml");  // a file cannot replace a directory
  EXPECT_THROW(replaceFile(folder / "a.yaml", "x"), InputError);
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace fsr::settings
