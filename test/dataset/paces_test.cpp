#include "dataset/protocols.h"

#include <gtest/gtest.h>

#include "support/memory_rig.h"

namespace fsr::dataset {
namespace {

using test_support::MemoryCycles;

std::vector<Recording> programmed(const std::vector<MemoryCycles>& program) {
  test_support::MemoryRig rig;
  rig.program = program;
  return {test_support::memoryRecording(rig)};
}

TEST(Paces, AreOneForEachKindOfCycle) {
  const std::vector<CycleCourse> one = pacesOf(programmed({{6, 600e3, 20e3, 20, 2}}));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(one[0].speed, 20e3, 1e3);
  EXPECT_NEAR(one[0].dwell, 20, 2);  // rates are taken over two seconds
  EXPECT_NEAR(one[0].peak, 600e3, 1e3);
  EXPECT_EQ(pacesOf(programmed({{4, 600e3, 20e3, 2, 2}, {4, 600e3, 60e3, 2, 2}})).size(), 2u);
}

TEST(Paces, AreThoseOfAnotherRecordingOfTheSameProtocolOnly) {
  const std::vector<CycleCourse> paces = pacesOf(programmed({{6, 600e3, 20e3, 2, 2}}));
  EXPECT_TRUE(havePaces(programmed({{4, 580e3, 22e3, 2, 2}}), paces)) << "by hand";
  EXPECT_TRUE(havePaces(programmed({{5, 600e3, 20e3, 2, 2}, {1, 100e3, 20e3, 1, 0}}), paces)) << "a stump";
  EXPECT_FALSE(havePaces(programmed({{4, 600e3, 60e3, 2, 2}}), paces)) << "another speed";
  EXPECT_FALSE(havePaces(programmed({{4, 600e3, 20e3, 20, 2}}), paces)) << "dwells";
  EXPECT_FALSE(havePaces(programmed({{4, 300e3, 20e3, 2, 2}}), paces)) << "another peak";
}

}  // namespace
}  // namespace fsr::dataset
