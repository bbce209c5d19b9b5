#pragma once

#include <gtest/gtest.h>
#include <ros/this_node.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace test_support {

/// A filter for the tests in `NAME.cpp`; empty if there are none.
inline std::string testsIn(const std::string& name) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const testing::TestInfo& test = *suite.GetTestInfo(j);
      if (std::filesystem::path(test.file()).stem() != name) continue;
      filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

/// Runs the tests of the source that is called like this node, which the launch file names: each needs other
/// nodes beside it.
inline int runTestsOfThisNode() {
  const std::string name = std::filesystem::path(ros::this_node::getName()).filename();
  testing::GTEST_FLAG(filter) = testsIn(name);
  if (!testing::GTEST_FLAG(filter).empty()) return RUN_ALL_TESTS();
  std::fprintf(stderr, "there are no tests in %s.cpp\n", name.c_str());
  return 2;  // without a file of results: to rostest, no tests would be success
}

}  // namespace test_support
