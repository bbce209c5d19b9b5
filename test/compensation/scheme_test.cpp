#include "fsr_pressure_map/compensation/scheme.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::compensation {
namespace {

TEST(Scheme, IsFoundByItsName) {
  for (const std::string& name : schemeNames()) EXPECT_EQ(schemeName(schemeFromName(name)), name);
}

TEST(Scheme, AnUnknownNameIsRefusedWithTheKnownOnes) {
  try {
    schemeFromName("per_curve");
    FAIL() << "accepted";
  } catch (const settings::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "scheme is \"per_curve\", but must be one of flat_only, baseline, per_curvature, "
                 "curvature_input, one_hot, flat_or_curved, binary_input, scaled_curvature, curvature_map, "
                 "curvature_ranges, interpolated, per_surface");
  }
}

}  // namespace
}  // namespace fsr::compensation
