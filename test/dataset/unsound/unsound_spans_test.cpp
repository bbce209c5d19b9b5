#include "dataset/unsound_spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fsr::dataset {
namespace {

constexpr std::int64_t kScan = 100'000'000;  // from one scan to the next [ns]

// Cycles of 20 s to 600 kPa at 10 Hz, 5 s of rest before and after each; the sheet reads the root of the
// pressure.
ScanCourse cycles(std::size_t number, std::uint32_t condition = 0, double preload = 0) {
  ScanCourse course;
  for (std::size_t i = 0; i < 300 * number; ++i) {
    const double phase = std::clamp((double(i % 300) - 50) / 200, 0.0, 1.0);
    course.stamp_ns.push_back(static_cast<std::int64_t>(i) * kScan);
    course.pressure.push_back(600e3 * std::min(2 * phase, 2 - 2 * phase));
    course.reading.push_back(preload + 2 * std::sqrt(course.pressure.back()));
    course.condition.push_back(condition);
  }
  return course;
}

std::vector<AttemptEnd> endedAt(std::initializer_list<std::pair<std::int64_t, RejectReason>> ends) {
  std::vector<AttemptEnd> all;
  for (const auto& [scan, reason] : ends) all.push_back({scan * kScan, reason});
  return all;
}

TEST(RejectedSpans, ReachFromTheRestBeforeTheAttemptToTheRestAfterIt) {
  const ScanCourse course = cycles(4);
  // The last scan at rest of cycle 2 is 351, its first one 549; an attempt is rejected in it, or behind it.
  for (const std::int64_t said : {430, 580}) {
    const auto spans = rejectedSpans(
        course, endedAt({{280, RejectReason::kNone}, {said, RejectReason::kSheetOff}, {880, {}}}));
    ASSERT_EQ(spans.size(), 1u);
    EXPECT_EQ(spans[0].first, 351u);
    EXPECT_EQ(spans[0].end, said == 430 ? 550u : 581u);
    EXPECT_EQ(spans[0].why, "attempt rejected: sheet_off");
  }
}

TEST(RejectedSpans, AreOfReasonsByWhichReadingsMisleadOnly) {
  const ScanCourse course = cycles(2);
  EXPECT_TRUE(rejectedSpans(course, endedAt({{430, RejectReason::kPeakMissed}})).empty());
  EXPECT_TRUE(rejectedSpans(course, endedAt({{430, RejectReason::kNone}})).empty());
  EXPECT_EQ(rejectedSpans(course, endedAt({{430, RejectReason::kPressureNotFollowed}})).size(), 1u);
}

// The transducer tells no rest while it is dead: the sheet does.
TEST(RejectedSpans, DoNotEndWhereADeadTransducerReadsZero) {
  ScanCourse course = cycles(3);
  std::fill(course.pressure.begin() + 400, course.pressure.begin() + 450, 0.0);
  const auto spans = rejectedSpans(course, endedAt({{420, RejectReason::kPressureInvalid}}));
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_EQ(spans[0].first, 351u);
  EXPECT_EQ(spans[0].end, 550u);
}

TEST(RejectedSpans, StayBetweenTheAttemptsBeforeAndAfter) {
  ScanCourse course = cycles(1);
  for (double& pressure : course.pressure) pressure += 50e3;  // partial loops: never at rest
  const auto spans = rejectedSpans(
      course, endedAt({{100, RejectReason::kNone}, {150, RejectReason::kPressureLost}, {200, {}}}));
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_EQ(spans[0].first, 101u);
  EXPECT_EQ(spans[0].end, 201u);
}

TEST(RejectedSpans, KnowTheRestOfEachSurface) {
  ScanCourse course = cycles(3), bent = cycles(3, 1, 800);  // more than a tenth of the flat sheet's range
  for (std::size_t i = 0; i < bent.scans(); ++i) {
    course.stamp_ns.push_back(bent.stamp_ns[i] + course.stamp_ns[899] + kScan);
    course.pressure.push_back(bent.pressure[i]);
    course.reading.push_back(bent.reading[i]);
    course.condition.push_back(1);
  }
  const auto spans = rejectedSpans(course, endedAt({{900 + 430, RejectReason::kTaxelFellOut}}));
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_EQ(spans[0].first, 900u + 351);
  EXPECT_EQ(spans[0].end, 900u + 550);
}

TEST(UnsoundText, CountsScansOnceAndNamesFiveSpans) {
  const ScanCourse course = cycles(1);
  EXPECT_EQ(unsoundText(course, {}), "");
  EXPECT_EQ(unsoundText(course, {{10, 21, "a"}, {15, 26, "b"}}),
            "left out 16 scans that are not the sheet under the recorded pressure: 1.0 to 2.0 s (a), 1.5 to "
            "2.5 s (b)");
  const std::string many = unsoundText(course, std::vector<UnsoundSpan>(7, UnsoundSpan{10, 11, "a"}));
  EXPECT_EQ(many.substr(0, 25), "left out 1 scan that is n");
  EXPECT_EQ(many.substr(many.size() - 10), "and 2 more");
}

}  // namespace
}  // namespace fsr::dataset
