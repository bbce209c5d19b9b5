#include "dataset/unsound_spans.h"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace fsr::dataset;

TEST(RejectReason, EachHasANameAndIsFoundInTheLabelOfItsEvent) {
  std::set<std::string> names;
  for (const RejectReason reason : allRejectReasons()) {
    names.insert(name(reason));
    const std::string label =
        rejectLabel("cycle 3 of 5 on flat, mount 2", reason, "the table was hit (hard): twice");
    EXPECT_EQ(rejectReasonIn(label), reason) << label;
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(RejectReason::kByHand));
  EXPECT_EQ(names.count(""), 0u);
}

TEST(RejectReason, IsNoneInALabelThatAPersonWrote) {
  for (const char* label :
       {"", "rejected", "the sheet slipped", "it was rejected (sheet_off)x", "a rejected (no such): b"})
    EXPECT_EQ(rejectReasonIn(label), RejectReason::kNone) << label;
}

// With these the pressure, the surface or the readings beside them are not true.
TEST(RejectReason, ReadingsMisleadWhereTheyAreNotTheSheetUnderThePressure) {
  std::set<std::string> misleading;
  for (const RejectReason reason : allRejectReasons()) {
    if (readingsMislead(reason)) misleading.insert(name(reason));
  }
  EXPECT_EQ(misleading, (std::set<std::string>{"other_surface", "pressure_invalid", "pressure_lost",
                                               "pressure_not_followed", "sheet_off", "taxel_fell_out"}));
  EXPECT_FALSE(readingsMislead(RejectReason::kNone));
}

}  // namespace
