// Tests which evidence the recordings contain to distinguish slow effects.

#include "discrepancy/samples/available_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "discrepancy/planted.h"

namespace fsr::discrepancy {
namespace {

using planted::kTwoSurfaces;
const std::string kFlatAgainHoursLater = "  - {surface: flat, flat: true, pause: 10000}\n";

AvailableEvidence evidenceOf(const std::string& more) {
  return availableEvidence(admit(planted::problem(planted::kFourTaxels + more, "")));
}

TEST(Evidence, HoursWithoutACycleSeparateClockTimeFromPathLength) {
  EXPECT_FALSE(evidenceOf(kTwoSurfaces).has(simulation::Evidence::kUnevenPace));
  EXPECT_TRUE(evidenceOf(kTwoSurfaces + kFlatAgainHoursLater).has(simulation::Evidence::kUnevenPace));
}

TEST(Evidence, AMountThatIsRecordedAgainAfterAPauseHasTwoSessions) {
  DiscrepancyProblem problem =
      planted::problem(planted::kFourTaxels + std::string("  - {surface: flat, flat: true}\n") +
                           "  - {surface: flat, flat: true, pause: 300}\n",
                       "");
  EXPECT_FALSE(availableEvidence(admit(problem)).has(simulation::Evidence::kTwoSessions));
  for (matrix::Surface& surface : problem.recordings.at(1).conditions) surface.mount = 1;
  EXPECT_TRUE(availableEvidence(admit(problem)).has(simulation::Evidence::kTwoSessions));
}

// Recordings whose pressure follows sines of these periods [s], one after the other.
AvailableEvidence evidenceOfSines(const std::vector<double>& periods) {
  DiscrepancyProblem problem = planted::problem(planted::kFourTaxels + kTwoSurfaces, "");
  for (dataset::Recording& recording : problem.recordings) {
    double phase = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const std::size_t at = i * periods.size() / recording.scans();
      if (i > 0) phase += (recording.time[i] - recording.time[i - 1]) / periods[at];
      recording.pressure[i] = 300e3 * (1 - std::cos(2 * 3.14159265358979 * phase));
    }
  }
  return availableEvidence(admit(problem));
}

TEST(Evidence, ASineOfOneFrequencyHasOnePace) {
  EXPECT_FALSE(evidenceOfSines({60}).two_rates);
  EXPECT_TRUE(evidenceOfSines({30, 80}).two_rates);
}

TEST(Evidence, RampsOfTwoSpeedsOrDwellsAreTwoPaces) {
  EXPECT_TRUE(availableEvidence(admit(planted::problem(planted::kTwoSpeeds, ""))).two_rates);
  EXPECT_FALSE(availableEvidence(admit(planted::problem(planted::kOneSpeed, ""))).two_rates);
}

TEST(Evidence, ASurfaceThatIsMountedTwiceIsNoticed) {
  EXPECT_FALSE(evidenceOf(kTwoSurfaces).remounted);
  EXPECT_TRUE(evidenceOf(kTwoSurfaces + kFlatAgainHoursLater).remounted);
}

}  // namespace
}  // namespace fsr::discrepancy
