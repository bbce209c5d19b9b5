#include "settings/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "settings/settings.h"
#include "settings/sha256.h"
#include "support/holds.h"
#include "support/pty.h"

namespace fsr::settings {
namespace {

std::string complaint(const std::function<void()>& read) {
  return test_support::refusal([&] { read(); }, "accepted");
}

TEST(RegularFile, ReadsToItsEnd) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.path("a")) << "abcdef";
  RegularFile file(folder.path("a"), 6);
  char two[2];
  EXPECT_EQ(file.read(two, 2), 2u);
  EXPECT_EQ(file.rest(), "cdef");
  EXPECT_EQ(file.read(two, 2), 0u);
}

// A pipe without a writer would block every one of these for ever.
TEST(RegularFile, RefusesWhatIsNoFile) {
  const test_support::TemporaryFolder folder;
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string why = pipe + ": is a device or a pipe; give the path of a file";
  EXPECT_EQ(complaint([&] { requireRegularFile(pipe); }), why);
  EXPECT_EQ(complaint([&] { Settings::fromFile(pipe); }), why);
  EXPECT_EQ(complaint([&] { sha256OfFile(pipe); }), why);
  EXPECT_TRUE(test_support::holds(complaint([&] { requireRegularFile("/dev/zero"); }),
                                  {"/dev/zero", "is a device or a pipe"}));
  EXPECT_TRUE(test_support::holds(complaint([&] { Settings::fromFile(folder.path()); }),
                                  {folder.path(), "is a folder"}));
  EXPECT_TRUE(test_support::holds(complaint([&] { requireRegularFile(folder.path("none")); }),
                                  {folder.path("none"), "there is no such file"}));
}

TEST(RegularFile, RefusesALargerFile) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.path("a")) << "abcdef";
  EXPECT_TRUE(test_support::holds(complaint([&] { requireRegularFile(folder.path("a"), 5); }),
                                  {folder.path("a"), "6 bytes", "5 bytes"}));
}

}  // namespace
}  // namespace fsr::settings
