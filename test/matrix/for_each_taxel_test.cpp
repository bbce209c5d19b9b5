#include "matrix/for_each_taxel.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <system_error>
#include <thread>
#include <vector>

namespace fsr::matrix {
namespace {

constexpr int kDone = 0, kWrong = 1, kUnlimited = 2;

// Whether the system refuses this process further threads. Root is not limited, so it becomes another user.
bool getsNoThread() {
  const rlimit none{0, 0};
  if (setrlimit(RLIMIT_NPROC, &none) != 0) return false;
  if (geteuid() == 0 && setuid(65534) != 0) return false;
  try {
    std::thread([] {}).join();
  } catch (const std::system_error&) {
    return true;
  }
  return false;
}

[[noreturn]] void countWithoutThreads() {
  if (!getsNoThread()) std::_Exit(kUnlimited);
  std::vector<int> calls(100);
  forEachTaxel(calls.size(), 4, [&](std::size_t taxel) { ++calls[taxel]; });
  std::_Exit(calls == std::vector<int>(100, 1) ? kDone : kWrong);
}

TEST(ForEachTaxel, DoesTheWorkInTheCallersThreadWhereNoOtherCanStart) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(countWithoutThreads(), testing::ExitedWithCode(kDone), "");
}

}  // namespace
}  // namespace fsr::matrix
