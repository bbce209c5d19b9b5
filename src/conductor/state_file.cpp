#include "conductor/state_file.h"

#include "settings/replace_file.h"
#include "settings/settings.h"
#include "settings/yaml_text.h"

namespace fsr::conductor {

void writeState(const std::string& path, const ConductorState& state) {
  std::string steps;
  for (const StepState one : state.steps) steps += static_cast<char>(one);
  settings::replaceFile(
      path,
      "# A session that conduct goes on with.\nplan: " + settings::quotedText(state.plan) +
          "\ndigest: " + settings::quotedText(state.digest) + "\ntime: " + settings::numberText(state.time) +
          "\nrejected: " + std::to_string(state.rejected) + "\nsteps: " + settings::quotedText(steps) + "\n");
}

ConductorState readState(const std::string& path) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  ConductorState state;
  state.plan = settings.text("plan");
  state.digest = settings.text("digest");
  state.time = settings.number("time", {0, 1e12, "s"});
  state.rejected = static_cast<unsigned>(settings.integer("rejected", {0, 1e9, "attempts"}));
  for (const char one : settings.text("steps")) {
    if (one != '.' && one != 'a' && one != 's') {
      throw settings.error("steps", "must consist of a (accepted), s (skipped) and . (open)");
    }
    state.steps.push_back(static_cast<StepState>(one));
  }
  settings.refuseUnknown();
  return state;
}

}  // namespace fsr::conductor
