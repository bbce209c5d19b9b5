#include "dataset/protocols.h"

#include <gtest/gtest.h>

#include <set>

#include "support/memory_rig.h"

namespace fsr::dataset {
namespace {

using test_support::MemoryCycles;

Protocols protocolsOfProgram(const std::vector<MemoryCycles>& program) {
  test_support::MemoryRig rig;
  rig.program = program;
  const std::vector<Recording> recordings = {test_support::memoryRecording(rig)};
  return protocolsOf(recordings, {divideIntoSections(recordings.front(), 5)});
}

TEST(Protocols, AreOneWhereAllCyclesAreAlike) {
  const Protocols protocols = protocolsOfProgram({{6, 600e3, 20e3, 2, 2}});
  EXPECT_EQ(protocols.names, (std::vector<std::string>{"all cycles"}));
}

TEST(Protocols, DifferInPaceDwellAndPeak) {
  const Protocols protocols = protocolsOfProgram(test_support::variedProgram());
  ASSERT_EQ(protocols.names.size(), 4u);
  const std::set<std::string> names(protocols.names.begin(), protocols.names.end());
  EXPECT_EQ(names.count("ramps of 20 kPa/s, dwells of 2 s, peaks of 600 kPa"), 1u) << protocols.names[0];
  EXPECT_EQ(names.count("ramps of 60.3 kPa/s, dwells of 2 s, peaks of 350 kPa"), 1u) << protocols.names[2];
  EXPECT_NEAR(protocols.longest_hold, 20, 2);
  EXPECT_DOUBLE_EQ(protocols.highest, 600e3);
}

// Every Ctrl-C leaves such a stump.
TEST(Protocols, TheStumpOfACycleIsNone) {
  std::vector<MemoryCycles> program = {{8, 600e3, 20e3, 2, 2}, {1, 100e3, 20e3, 1, 0}};
  const Protocols protocols = protocolsOfProgram(program);
  EXPECT_EQ(protocols.names.size(), 1u);
  EXPECT_EQ(protocols.of_scan[0].back(), Protocols::kOther);
}

TEST(Protocols, ThatVaryWithoutAJumpAreHalved) {
  std::vector<MemoryCycles> program;
  for (const double rate : {10e3, 13e3, 17e3, 22e3, 28e3, 36e3, 46e3, 60e3})
    program.push_back({1, 600e3, rate, 1, 1});
  EXPECT_EQ(protocolsOfProgram(program).names.size(), 2u);
}

}  // namespace
}  // namespace fsr::dataset
