#include "session/session_files.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/pty.h"

namespace fsr::session {
namespace {

namespace fs = std::filesystem;

std::set<std::string> filesIn(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory()) names.insert(entry.path().filename().string());
  }
  return names;
}

TEST(SessionFiles, SetAsideAllBagsOfAMountAndNoOthersAndWriteOverNone) {
  const test_support::TemporaryFolder folder;
  fs::create_directory(folder.path("set_aside"));
  for (const char* const name : {"day_02_flat.bag", "day_02_flat_part2.bag", "day_02_flat_part3.bag.active",
                                 "day_01_flat.bag", "day_02_flat_bowl.bag", "set_aside/day_02_flat.bag"})
    std::ofstream(folder.path(name)) << name;
  const auto moved = setMountAside(folder.path(), bagStem("day", 2, "flat"));
  ASSERT_EQ(moved.size(), 3u);
  for (const MovedBag& bag : moved) EXPECT_EQ(bag.failure, "") << bag.from;
  EXPECT_EQ(filesIn(folder.path()), (std::set<std::string>{"day_01_flat.bag", "day_02_flat_bowl.bag"}));
  EXPECT_EQ(filesIn(folder.path("set_aside")),
            (std::set<std::string>{"day_02_flat.bag", "copy2_day_02_flat.bag", "day_02_flat_part2.bag",
                                   "day_02_flat_part3.bag.active"}));
  std::string first;
  std::ifstream(folder.path("set_aside/day_02_flat.bag")) >> first;
  EXPECT_EQ(first, "set_aside/day_02_flat.bag");
}

TEST(SessionFiles, FindWhatASessionLeftOpen) {
  const test_support::TemporaryFolder folder;
  for (const char* const name : {"a_day_02_flat_part2.bag.active", "a_day_01_flat.bag.active",
                                 "a_day_01_flat.bag", "another_01_flat.bag.active", "a_day_session.yaml"})
    std::ofstream(folder.path(name)) << name;
  EXPECT_EQ(openBags(folder.path(), "a day"),
            (std::vector<std::string>{"a_day_01_flat.bag.active", "a_day_02_flat_part2.bag.active"}));
}

TEST(SessionFiles, SayWhyABagCannotBeSetAside) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.path("day_02_flat.bag")) << "precious";
  std::ofstream(folder.path("set_aside")) << "a file where the folder belongs";
  const auto moved = setMountAside(folder.path(), bagStem("day", 2, "flat"));
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NE(moved[0].failure, "");
  EXPECT_TRUE(fs::exists(folder.path("day_02_flat.bag")));
}

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
  EXPECT_THROW(FolderLock(folder.path("")), settings::InputError);
  ::kill(owner, SIGKILL);
  ASSERT_EQ(::waitpid(owner, nullptr, 0), owner);
  EXPECT_NO_THROW(FolderLock(folder.path("")));
  ::close(ready[0]), ::close(ready[1]);
}

}  // namespace
}  // namespace fsr::session
