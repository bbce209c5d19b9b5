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
  EXPECT_EQ(test_support::refusal([&] { schemeFromName("per_curve"); }),
            "scheme is \"per_curve\", but must be one of flat_only, baseline, per_curvature, "
            "curvature_input, one_hot, flat_or_curved, binary_input, scaled_curvature, curvature_map, "
            "curvature_ranges, interpolated, per_surface");
}

}  // namespace
}  // namespace fsr::compensation
