#include "settings/replace_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/content_of.h"
#include "support/file_size_limit.h"
#include "support/folder_test.h"
#include "support/holds.h"

namespace fsr::settings {
namespace {

namespace fs = std::filesystem;

class ReplaceFile : public test_support::FolderTest {
 protected:
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
};

TEST_F(ReplaceFile, LeavesOnlyTheNewContentAtThePath) {
  replaceFile(folder_ / "a.yaml", std::string("long old\0content", 16));
  replaceFile(folder_ / "a.yaml", std::string("new\0one", 7));
  EXPECT_EQ(test_support::contentOf(folder_ / "a.yaml"), std::string("new\0one", 7));
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, NamesThePathWhereItsFolderIsMissing) {
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { replaceFile("/nowhere/a.yaml", "x"); }),
                                  {"/nowhere/a.yaml", "cannot be written"}));
}

TEST_F(ReplaceFile, KeepsOnlyTheOldContentWhereTheDiskIsFull) {
  replaceFile(folder_ / "a.yaml", "old");
  const test_support::FileSizeLimit disk(1000);
  EXPECT_THROW(replaceFile(folder_ / "a.yaml", std::string(2000, 'x')), InputError);
  EXPECT_EQ(test_support::contentOf(folder_ / "a.yaml"), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, RemovesTheTemporaryFileWhenTheRenameFails) {
  fs::create_directory(folder_ / "a.yaml");  // a file cannot replace a directory
  EXPECT_THROW(replaceFile(folder_ / "a.yaml", "x"), InputError);
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, ReplacesOnlyFiles) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder_ / "link");
  fs::create_symlink("round", folder_ / "round");
  for (const fs::path& path : {folder_ / "pipe", folder_ / "link", folder_ / "round", fs::path("/dev/null"),
                               folder_ / std::string(300, 'x'), fs::path()}) {
    EXPECT_THROW(requireReplaceable(path), InputError) << path;
    EXPECT_THROW(replaceFile(path, "x"), InputError) << path;
  }
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(files(), 3u);
}

TEST_F(ReplaceFile, RecognisesAFileByAnyOfItsNames) {
  replaceFile(folder_ / "a", "x");
  fs::create_symlink("a", folder_ / "link");
  fs::create_hard_link(folder_ / "a", folder_ / "hard");
  fs::create_directory_symlink(folder_, folder_ / "here");
  for (const fs::path& name : {folder_ / "a", folder_ / "." / "here" / "a", folder_ / "link",
                               folder_ / "hard", folder_ / "here" / "a"}) {
    EXPECT_TRUE(sameFile(name, folder_ / "a")) << name;
  }
  EXPECT_TRUE(sameFile(folder_ / "new", folder_ / "here" / "new")) << "neither exists";
  EXPECT_FALSE(sameFile(folder_ / "a", folder_ / "b"));
}

TEST_F(ReplaceFile, GivesANewNameWithoutReplacingAnything) {
  replaceFile(folder_ / "a", "a");
  replaceFile(folder_ / "b", "b");
  EXPECT_EQ(renameToNew(folder_ / "a", folder_ / "b"), EEXIST);
  EXPECT_EQ(test_support::contentOf(folder_ / "b"), "b");
  EXPECT_EQ(renameToNew(folder_ / "a", folder_ / "c"), 0);
  EXPECT_EQ(test_support::contentOf(folder_ / "c"), "a");
}

}  // namespace
}  // namespace fsr::settings
