// Plants the forms of effects that a parameter selects, with the noise of config/simulation/demo_noisy.yaml,
// and checks that discrepancy finds the effect.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "discrepancy/planted.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {
namespace {

// Two speeds and dwells on two surfaces. White noise: config/simulation/demo_noisy.yaml.
const std::string kNoisyRig = planted::rig(R"(program:
  - hold: {pressure: 310000, rate: 40000, duration: 30}
  - rest: {rate: 40000, duration: 20}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 620000, rate: 8000, dwell_peak: 30, cycles: 2}
  - cycles: {peak: 200000, rate: 20000, dwell_peak: 4, cycles: 4}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 3}
)",
                                           planted::kTwoSurfaces, "{absolute: 70, relative: 0.01}");

// A room that warms and cools.
const char* const kWarmingRoom =
    "climate: {room: [{time: 0, temperature: 23}, {time: 500, temperature: 31}, {time: 900, temperature: "
    "25}, "
    "{time: 1600, temperature: 33}]}\n";

struct Planted {
  std::string effect;
  std::string line;
  std::string parameter;  // that tells the form
  double value;
  std::string climate = {};
};

std::ostream& operator<<(std::ostream& stream, const Planted& planted) {
  return stream << planted.line;
}

class EffectForms : public testing::TestWithParam<Planted> {};

TEST_P(EffectForms, IsFound) {
  const DiscrepancyReport report =
      investigate(planted::problem(GetParam().climate + kNoisyRig, "  " + GetParam().line + "\n"));
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.front(), std::vector<std::string>{GetParam().effect}) << report.sentence;
  ASSERT_FALSE(report.effects.empty());
  const auto& fitted = report.effects.front().parameters;
  const auto own = std::find_if(fitted.begin(), fitted.end(),
                                [](const FittedParameter& one) { return one.name == GetParam().parameter; });
  ASSERT_NE(own, fitted.end());
  EXPECT_NEAR(own->value, GetParam().value, 0.15 * std::abs(GetParam().value));
}

TEST(EffectForms, NothingHiddenIsSilentAndASessionOffsetNeedsTwoSessions) {
  const DiscrepancyReport report = investigate(planted::problem(kWarmingRoom + std::string(kNoisyRig), ""));
  EXPECT_EQ(report.verdict, Verdict::kNone) << report.sentence;
  const auto& hidden = report.not_identifiable;
  const auto session =
      std::find_if(hidden.begin(), hidden.end(), [](const auto& one) { return one.id == "session_offset"; });
  ASSERT_NE(session, hidden.end());
  EXPECT_EQ(session->reason, "It needs two sessions.");
}

INSTANTIATE_TEST_SUITE_P(
    Library, EffectForms,
    testing::Values(Planted{"relaxation", "relaxation: {}", "relaxed_share", 0.05},
                    Planted{"hysteresis", "hysteresis: {rayleigh: 1}", "rayleigh", 1},
                    Planted{"seal_leak", "seal_leak: {orifice_share: 1}", "share", 1},
                    Planted{"temperature", "temperature: {coefficient: 0, zero_shift: 800}", "zero_shift",
                            800, kWarmingRoom},
                    Planted{"wear", "wear: {loss: 0.1, exponent: 1, fading: 8}", "fading", 8, kWarmingRoom},
                    Planted{"time_skew", "time_skew: {delay: 0, rate: 1e-3}", "rate", 1e-3},
                    Planted{"time_skew", "time_skew: {delay: 5}", "delay", 5},
                    Planted{"time_skew", "time_skew: {delay: -5}", "delay", -5}));

}  // namespace
}  // namespace fsr::discrepancy
