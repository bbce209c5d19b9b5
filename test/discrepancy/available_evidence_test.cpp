// Tests which evidence the recordings contain to distinguish slow effects.

#include "discrepancy/samples/available_evidence.h"

#include <gtest/gtest.h>

#include "discrepancy/planted.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {
namespace {

using planted::kTwoSurfaces;
const std::string kFlatAgainHoursLater = "  - {surface: flat, flat: true, pause: 10000}\n";

AvailableEvidence evidenceOf(const std::string& more) {
  return availableEvidence(admit(planted::problem(planted::kFourTaxels + more, "")));
}

TEST(Evidence, HoursWithoutACycleSeparateClockTimeFromPathLength) {
  EXPECT_FALSE(evidenceOf(kTwoSurfaces).apartFromClock(simulation::EffectLibrary::shipped().info("wear")));
  EXPECT_TRUE(evidenceOf(kTwoSurfaces + kFlatAgainHoursLater)
                  .apartFromClock(simulation::EffectLibrary::shipped().info("wear")));
}

TEST(Evidence, ARoomThatWarmsAndCoolsSeparatesTemperatureFromClockTime) {
  const std::string thrice = kTwoSurfaces + kFlatAgainHoursLater +
                             "  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: 10000}\n";
  EXPECT_FALSE(
      evidenceOf(thrice + "climate: {room: [{time: 0, temperature: 23}, {time: 25000, temperature: 23}]}\n")
          .apartFromClock(simulation::EffectLibrary::shipped().info("temperature")));
  const AvailableEvidence warmed =
      evidenceOf(thrice +
                 "climate: {room: [{time: 0, temperature: 23}, {time: 5000, temperature: 23}, {time: 10500, "
                 "temperature: 35}, {time: 11500, temperature: 35}, {time: 20000, temperature: 23}]}\n");
  EXPECT_TRUE(warmed.temperature_moved);
  EXPECT_TRUE(warmed.apartFromClock(simulation::EffectLibrary::shipped().info("temperature")));
}

TEST(Evidence, ASurfaceThatIsMountedTwiceIsNoticed) {
  EXPECT_FALSE(evidenceOf(kTwoSurfaces).remounted);
  EXPECT_TRUE(evidenceOf(kTwoSurfaces + kFlatAgainHoursLater).remounted);
}

}  // namespace
}  // namespace fsr::discrepancy
