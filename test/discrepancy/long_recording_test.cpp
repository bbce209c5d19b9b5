// What is found does not depend on where the counts of the recordings are.

#include <gtest/gtest.h>

#include "discrepancy/planted.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "support/counts_in_file.h"

namespace fsr::discrepancy {
namespace {

TEST(LongRecording, GivesTheSameVerdictFaultsAndGap) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n");
  problem.options.null_draws = 49;
  dataset::Recording& first = problem.recordings.front();  // one taxel goes dead in the middle of it
  for (std::size_t i = first.scans() / 3; i < first.scans() / 2; ++i)
    first.counts[i * first.layout.size.taxels() + 5] = 0;
  const DiscrepancyReport memory = investigate(problem);
  problem.recordings = test_support::countsInFiles(problem.recordings);
  const DiscrepancyReport file = investigate(problem);
  EXPECT_EQ(file.sentence, memory.sentence);
  EXPECT_EQ(file.limitations, memory.limitations);
  EXPECT_EQ(file.gap.before, memory.gap.before);
  EXPECT_EQ(file.gap.after, memory.gap.after);
  ASSERT_FALSE(memory.effects.empty()) << memory.sentence;
  ASSERT_EQ(file.effects.size(), memory.effects.size());
  for (std::size_t i = 0; i < file.effects.size(); ++i) {
    EXPECT_EQ(file.effects[i].id, memory.effects[i].id);
    EXPECT_EQ(file.effects[i].z, memory.effects[i].z);
  }
}

}  // namespace
}  // namespace fsr::discrepancy
