// Two effects that may be one in a form that the library does not have.

#include "discrepancy/decide/second_effect.h"

#include <gtest/gtest.h>

namespace fsr::discrepancy {
namespace {

Explanation explanation(std::vector<std::string> ids, double share) {
  Explanation one;
  one.score.ids = std::move(ids);
  one.share = share;
  return one;
}

TEST(SecondEffect, ALoopWithABreakInMayBeACreepThatComesNear) {
  const Explanation pair = explanation({"hysteresis", "break_in"}, 0.94);
  EXPECT_TRUE(mayBeOne(explanation({"creep"}, 0.85), pair));
  EXPECT_FALSE(mayBeOne(explanation({"creep"}, 0.6), pair));
  EXPECT_FALSE(mayBeOne(explanation({"wear"}, 0.9), pair));
  EXPECT_FALSE(mayBeOne(explanation({"creep"}, 0.9), explanation({"hysteresis", "time_skew"}, 0.94)));
}

}  // namespace
}  // namespace fsr::discrepancy
