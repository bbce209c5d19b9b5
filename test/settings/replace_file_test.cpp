#include "settings/replace_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
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
  replaceFile(folder / "a.yaml", std::string("long old\0content", 16));
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

TEST_F(ReplaceFile, ReplacesOnlyFiles) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link");
  fs::create_symlink("round", folder / "round");
  for (const fs::path& path : {folder / "pipe", folder / "link", folder / "round", fs::path("/dev/null"),
                               folder / std::string(300, 'x'), fs::path()}) {
    EXPECT_THROW(requireReplaceable(path), InputError) << path;
    EXPECT_THROW(replaceFile(path, "x"), InputError) << path;
  }
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(files(), 3u);
}

TEST_F(ReplaceFile, RecognisesAFileByAnyOfItsNames) {
  replaceFile(folder / "a", "x");
  fs::create_symlink("a", folder / "link");
  fs::create_hard_link(folder / "a", folder / "hard");
  fs::create_directory_symlink(folder, folder / "here");
  for (const fs::path& name :
       {folder / "a", folder / "." / "here" / "a", folder / "link", folder / "hard", folder / "here" / "a"}) {
    EXPECT_TRUE(sameFile(name, folder / "a")) << name;
  }
  EXPECT_TRUE(sameFile(folder / "new", folder / "here" / "new")) << "neither exists";
  EXPECT_FALSE(sameFile(folder / "a", folder / "b"));
}

TEST_F(ReplaceFile, GivesANewNameWithoutReplacingAnything) {
  replaceFile(folder / "a", "a");
  replaceFile(folder / "b", "b");
  EXPECT_EQ(renameToNew(folder / "a", folder / "b"), EEXIST);
  EXPECT_EQ(contentOf(folder / "b"), "b");
  EXPECT_EQ(renameToNew(folder / "a", folder / "c"), 0);
  EXPECT_EQ(contentOf(folder / "c"), "a");
}

}  // namespace
}  // namespace fsr::settings
