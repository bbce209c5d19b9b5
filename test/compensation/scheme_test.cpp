#include "fsr_pressure_map/compensation/scheme.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::compensation {
namespace {

TEST(Scheme, IsFoundByItsName) {
  for (const std::string& name : schemeNames()) EXPECT_EQ(schemeName(schemeFromName(name)), name);
}

TEST(Scheme, AnUnknownNameIsRefusedWithTheKnownOnes) {
  EXPECT_TRUE(test_support::holds(
      test_support::refusal([&] { schemeFromName("per_curve"); }),
      {"scheme is \"per_curve\"", "flat_only", "per_curvature", "curvature_input", "per_surface"}));
}

}  // namespace
}  // namespace fsr::compensation
