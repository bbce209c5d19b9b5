#include "settings/progress.h"

#include <gtest/gtest.h>

#include <sstream>

namespace fsr::settings {
namespace {

const std::string kClear = "\r\033[K";

// What is written, by a clock that the test sets.
class ProgressTest : public testing::Test {
 protected:
  std::string written() {
    const std::string text = out_.str();
    out_.str("");
    return text;
  }

  double now_ = 1000;  // [s]
  std::ostringstream out_;
  Progress::Clock clock_ = [this] { return now_; };
};

TEST_F(ProgressTest, IsSilentForShortWork) {
  Progress progress(out_, true, clock_);
  progress.report("reading", 0);
  now_ += 1.9;
  progress.report("reading", 0.9);
  EXPECT_EQ(written(), "");
}

TEST_F(ProgressTest, TellsShareAndTimeLeftOnATerminal) {
  Progress progress(out_, true, clock_);
  progress.report("reading", 0);
  now_ += 10;
  progress.report("reading", 0.25);
  EXPECT_EQ(written(), kClear + "reading: 25 %, 30 s left");
  now_ += 0.2;
  progress.report("reading", 0.26);
  EXPECT_EQ(written(), "") << "too soon";
  now_ += 9.8;
  progress.report("reading", 0.5);
  EXPECT_EQ(written(), kClear + "reading: 50 %, 20 s left");
  progress.clear();
  EXPECT_EQ(written(), kClear);
  progress.clear();
  EXPECT_EQ(written(), "") << "nothing to remove";
}

TEST_F(ProgressTest, CountsTheTimeLeftAnewWhereOtherWorkBegins) {
  Progress progress(out_, true, clock_);
  progress.report("reading", 0);
  now_ += 100;
  progress.report("reading", 1);
  EXPECT_EQ(written(), kClear + "reading: 100 %");
  now_ += 1;
  progress.report("fitting", 0.5);
  EXPECT_EQ(written(), kClear + "fitting: 50 %") << "no time left is known yet";
  now_ += 10;
  progress.report("testing", 0.75);
  EXPECT_EQ(written(), kClear + "testing: 75 %, 10 s left");
}

TEST_F(ProgressTest, WritesALineAMinuteIntoAFile) {
  {
    Progress progress(out_, false, clock_);
    for (int second = 0; second <= 125; ++second, ++now_) progress.report("reading", second / 250.0);
  }
  EXPECT_EQ(written(), "reading: 24 %, 4 min left\nreading: 48 %, 3 min left\n");
}

TEST_F(ProgressTest, LeavesTheTerminalClean) {
  {
    Progress progress(out_, true, clock_);
    now_ += 5;
    progress.report("reading", 0.5);
  }
  EXPECT_EQ(written(), kClear + "reading: 50 %" + kClear);
}

TEST(DurationText, HasTwoDigitsAtMostOfItsUnit) {
  EXPECT_EQ(durationText(0.2), "1 s");
  EXPECT_EQ(durationText(89), "89 s");
  EXPECT_EQ(durationText(91), "2 min");
  EXPECT_EQ(durationText(5400), "1.5 h");
}

}  // namespace
}  // namespace fsr::settings
