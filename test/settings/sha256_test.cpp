#include "settings/sha256.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::settings {
namespace {

TEST(Sha256, AgreesWithCoreutils) {
  // printf '' | sha256sum ; printf abc | sha256sum
  EXPECT_EQ(sha256("", 0), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const std::string path = testing::TempDir() + "sha256_" + std::to_string(::getpid());
  std::string bytes(3000000, 'x');  // more than one chunk
  bytes[2999999] = 'y';
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(sha256OfFile(path), sha256(bytes.data(), bytes.size()));
  std::remove(path.c_str());
}

TEST(Sha256, AFileThatIsNotThereIsNamed) {
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { sha256OfFile("/nonexistent/file.bag"); }),
                                  {"/nonexistent/file.bag", "there is no such file"}));
}

}  // namespace
}  // namespace fsr::settings
