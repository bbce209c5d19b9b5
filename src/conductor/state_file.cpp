#include "conductor/state_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "conductor/session_files.h"
#include "session_plan/plan_file.h"
#include "settings/replace_file.h"
#include "settings/settings.h"
#include "settings/sha256.h"
#include "settings/yaml_text.h"

namespace fsr::conductor {

namespace {

std::string remarksText(const std::vector<StepRemark>& remarks) {
  std::string text;
  for (const StepRemark& remark : remarks) {
    const std::string reason = remark.reason == Reason::kNone ? "" : ", reason: " + name(remark.reason);
    text += "  - {step: " + std::to_string(remark.step + 1) + reason +
            ", sentence: " + settings::quotedText(remark.sentence) + "}\n";
  }
  return text.empty() ? "" : "remarks:\n" + text;
}

Reason reasonCalled(const settings::Settings& entry) {
  if (!entry.has("reason")) return Reason::kNone;
  std::vector<std::string> names;
  for (const Reason reason : dataset::allRejectReasons()) names.push_back(name(reason));
  const std::string called = entry.choice("reason", names);
  return dataset::allRejectReasons()[static_cast<std::size_t>(std::find(names.begin(), names.end(), called) -
                                                              names.begin())];
}

std::vector<StepRemark> readRemarks(const settings::Settings& settings, std::size_t steps) {
  std::vector<StepRemark> remarks;
  if (!settings.has("remarks")) return remarks;
  const settings::Range range{1, static_cast<double>(std::max<std::size_t>(steps, 1)), ""};
  for (const settings::Settings& entry : settings.sections("remarks")) {
    const auto step = static_cast<std::size_t>(entry.integer("step", range));
    remarks.push_back({step - 1, reasonCalled(entry), entry.text("sentence")});
  }
  return remarks;
}

// The digest of a state was that of the plan's text, as it was worded then. It is beside the state, below a
// remark of one line.
std::string digestOfContent(const std::string& digest, const std::filesystem::path& plan) {
  std::ifstream file(plan, std::ios::binary);
  std::string remark;
  std::getline(file, remark);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (text.empty() || settings::sha256(text.data(), text.size()) != digest) return digest;
  return digestOf(session_plan::readPlanFile(plan.string()));
}

}  // namespace

void writeState(const std::string& path, const ConductorState& state) {
  std::string steps;
  for (const StepState one : state.steps) steps += static_cast<char>(one);
  settings::replaceFile(
      path, "# A session that conduct goes on with.\nplan: " + settings::quotedText(state.plan) +
                "\ndigest: " + settings::quotedText(state.digest) + "\ntime: " +
                settings::numberText(state.time) + "\nrejected: " + std::to_string(state.rejected) +
                "\nsteps: " + settings::quotedText(steps) + "\n" + remarksText(state.remarks));
}

ConductorState readState(const std::string& path) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  ConductorState state;
  state.plan = settings.text("plan");
  state.digest = digestOfContent(settings.text("digest"),
                                 std::filesystem::path(path).parent_path() / planFileName(state.plan));
  state.time = settings.number("time", {0, 1e12, "s"});
  state.rejected = static_cast<unsigned>(settings.integer("rejected", {0, 1e9, "attempts"}));
  for (const char one : settings.text("steps")) {
    if (one != '.' && one != 'a' && one != 's') {
      throw settings.error("steps", "must consist of a (accepted), s (skipped) and . (open)");
    }
    state.steps.push_back(static_cast<StepState>(one));
  }
  state.remarks = readRemarks(settings, state.steps.size());
  settings.refuseUnknown();
  return state;
}

}  // namespace fsr::conductor
