#pragma once

#include <string>

#include "session/plan.h"
#include "support/holds.h"
#include "support/source_dir.h"

namespace example_plans {

using test_support::holds;
using test_support::refusal;

inline std::string folder() {
  return test_support::sourceDir() + "/config/surfaces";
}

inline fsr::session::SessionPlan shipped(const std::string& name) {
  return fsr::session::readPlanFile(test_support::sourceDir() + "/config/sessions/" + name + ".yaml");
}

inline fsr::session::SessionPlan planFrom(const std::string& yaml) {
  return fsr::session::readPlan(fsr::settings::Settings::fromText(yaml, "day.yaml"), folder());
}

/// The rest of a plan with two cycles of 62 s on one surface.
constexpr char kSmall[] =
    "plan: small\n"
    "surfaces: [{surface: flat}]\n"
    "program: [{cycles: {peak: 600000, rate: 20000, dwell_peak: 1, dwell_rest: 1, cycles: 2}}]\n";

}  // namespace example_plans
