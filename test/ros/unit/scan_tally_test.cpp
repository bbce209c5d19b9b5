#include "ros/recording/recorder.h"

#include <gtest/gtest.h>

namespace fsr_ros {
namespace {

fsr_pressure_map::MatrixFrame scan(std::uint32_t sequence, double stamp) {
  fsr_pressure_map::MatrixFrame frame;
  frame.sequence = sequence;
  frame.header.stamp = ros::Time(stamp);
  return frame;
}

TEST(ScanTally, SaysThatThereWereNone) {
  EXPECT_EQ(ScanTally().text(), "0 scans in 0.0 s (0 lost by the board's counter)");
}

TEST(ScanTally, CountsTheGapsOfTheBoardsCounter) {
  ScanTally tally;
  for (const std::uint32_t sequence : {0xfffffffeu, 0xffffffffu, 2u, 3u})
    tally.add(scan(sequence, 100 + sequence % 4));
  EXPECT_EQ(tally.scans(), 4u);
  EXPECT_EQ(tally.text(), "4 scans in 1.0 s (2 lost by the board's counter)");
}

TEST(ScanTally, ARestartOfTheBoardLosesNothing) {
  ScanTally tally;
  tally.add(scan(1000, 10));
  tally.add(scan(0, 12.5));
  EXPECT_EQ(tally.text(), "2 scans in 2.5 s (0 lost by the board's counter)");
}

}  // namespace
}  // namespace fsr_ros
