// Tests whether two effects may be one effect whose form is not in the library.

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
