// A plan of a session gives steps with finite times that follow each other, and is read again as it was
// written, or is refused with one sentence.
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "session/plan.h"
#include "session/plan_steps.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  namespace plans = fsr::session;
  try {
    const plans::SessionPlan plan = plans::readPlanFile(file.path());
    double end = 0;
    for (const plans::SessionStep& step : plans::sessionSteps(plan)) {
      fuzz::require(std::isfinite(step.duration) && step.duration >= 0 && step.begin >= end);
      end = step.begin;
    }
    const std::string text = plans::planText(plan);
    const auto again = plans::readPlan(fsr::settings::Settings::fromText(text, "plan"));
    fuzz::require(plans::planText(again) == text);
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
