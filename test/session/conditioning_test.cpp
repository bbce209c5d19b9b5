#include "dataset/conditioning.h"

#include <gtest/gtest.h>

#include "session/plan.h"

namespace fsr::session {
namespace {

TEST(PlannedConditioning, IsWhatIsRecognisedInRecordings) {
  const SessionPlan usual;
  const dataset::ConditioningOptions recognised;
  EXPECT_EQ(usual.conditioning.share_of_peak, recognised.share_of_peak);
  EXPECT_EQ(usual.tolerance.peak, recognised.tolerance);
  EXPECT_GE(usual.conditioning.cycles, recognised.cycles);
}

}  // namespace
}  // namespace fsr::session
