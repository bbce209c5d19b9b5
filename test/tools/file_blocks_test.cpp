#include "tools/memory/file_blocks.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

namespace fsr::tools {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

// Whether the block is a mapping of a file; and if so, whether that file has no name.
bool liesInUnnamedFile(const void* block) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const auto begin = std::stoull(line, nullptr, 16);
    const auto end = std::stoull(line.substr(line.find('-') + 1), nullptr, 16);
    const auto at = reinterpret_cast<std::uintptr_t>(block);
    if (begin <= at && at < end) return line.find(" (deleted)") != std::string::npos;
  }
  return false;
}

// Pages of files that are resident [bytes], field 3 of statm.
std::size_t residentOfFiles() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0, mapped = 0;
  statm >> size >> resident >> mapped;
  return mapped * 4096;
}

class FileBlocks : public testing::Test {
 protected:
  void TearDown() override { file_blocks::setLimit(file_blocks::kUsualLimit); }
};

TEST_F(FileBlocks, LieInFilesWithoutNames) {
  void* const block = file_blocks::make(kMegabyte);
  ASSERT_NE(block, nullptr);
  EXPECT_TRUE(liesInUnnamedFile(block));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 4096, 0u);
  EXPECT_TRUE(file_blocks::release(block));
  EXPECT_FALSE(file_blocks::release(block)) << "it has been given back";
}

TEST_F(FileBlocks, OfOthersAreNotReleased) {
  int number = 0;
  EXPECT_FALSE(file_blocks::release(&number));
  void* const page = std::aligned_alloc(4096, 4096);
  EXPECT_FALSE(file_blocks::release(page));
  std::free(page);
}

// The blocks together are ten times the limit. Their content is right, and little of it is resident.
TEST_F(FileBlocks, KeepTheirContentWhileTheirPagesAreGivenBack) {
  constexpr std::size_t kBlocks = 40, kNumbers = 8 * kMegabyte / sizeof(std::uint32_t);
  constexpr std::size_t kLimit = 32 * kMegabyte;
  file_blocks::setLimit(kLimit);
  std::vector<std::uint32_t*> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    blocks.push_back(static_cast<std::uint32_t*>(file_blocks::make(kNumbers * sizeof(std::uint32_t))));
    ASSERT_NE(blocks.back(), nullptr);
    std::iota(blocks.back(), blocks.back() + kNumbers, static_cast<std::uint32_t>(i * 7));
  }
  while (residentOfFiles() > 2 * kLimit) ::usleep(1000);  // ctest ends it where nothing is given back
  for (std::size_t i = 0; i < kBlocks; ++i) {
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < kNumbers; ++n) wrong += blocks[i][n] != static_cast<std::uint32_t>(i * 7 + n);
    EXPECT_EQ(wrong, 0u) << "block " << i;
    EXPECT_TRUE(file_blocks::release(blocks[i]));
  }
}

TEST_F(FileBlocks, AreForLargeBlocksOnceHalfOfTheLimitIsTaken) {
  EXPECT_FALSE(file_blocks::belongsInFile(kMegabyte)) << "the test itself takes far less than 160 MB";
  EXPECT_TRUE(file_blocks::belongsInFile(file_blocks::kUsualLimit));
  file_blocks::setLimit(0);
  EXPECT_TRUE(file_blocks::belongsInFile(file_blocks::kSmallest));
  EXPECT_FALSE(file_blocks::belongsInFile(file_blocks::kSmallest - 1));
}

TEST_F(FileBlocks, AreRefusedWhereAFolderCannotBeWrittenOrHasNoRoom) {
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("TMPDIR", "/no/such/folder", 1);
  EXPECT_EQ(file_blocks::make(kMegabyte + 1), nullptr);
  before != nullptr ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
  EXPECT_EQ(file_blocks::make(std::size_t{1} << 50), nullptr) << "a petabyte";
}

}  // namespace
}  // namespace fsr::tools
