#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/pty.h"

namespace test_support {

/// A test with an empty folder of its own, which is removed after it.
class FolderTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  const TemporaryFolder temporary_;

 protected:
  const std::filesystem::path folder_ = temporary_.path();
};

}  // namespace test_support
