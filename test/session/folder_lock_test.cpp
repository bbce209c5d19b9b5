#include "session/session_files.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/pty.h"

namespace {

using fsr::session::FolderLock;

TEST(FolderLock, IsHeldByOneConductorOfAFolder) {
  const test_support::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("other"));
  auto first = std::make_unique<FolderLock>(folder.path(""));
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { const FolderLock second(folder.path("")); }),
                                  {"another conductor leads a session in this folder"}));
  EXPECT_NO_THROW(FolderLock(folder.path("other")));
  first.reset();
  EXPECT_NO_THROW(FolderLock(folder.path("")));
}

TEST(FolderLock, DiesWithAnOwnerThatIsKilled) {
  const test_support::TemporaryFolder folder;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t owner = ::fork();
  if (owner == 0) {
    const FolderLock lock(folder.path(""));
    const bool told = ::write(ready[1], "x", 1) == 1;
    while (told) ::pause();
    ::_exit(1);
  }
  char one = 0;
  ASSERT_EQ(::read(ready[0], &one, 1), 1);
  EXPECT_THROW(FolderLock(folder.path("")), fsr::settings::InputError);
  ::kill(owner, SIGKILL);
  ASSERT_EQ(::waitpid(owner, nullptr, 0), owner);
  EXPECT_NO_THROW(FolderLock(folder.path("")));
  ::close(ready[0]), ::close(ready[1]);
}

}  // namespace
