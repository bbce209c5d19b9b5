#include "simulation/rig_state.h"

#include <cmath>
#include <limits>

#include "settings/yaml_text.h"

namespace fsr::simulation {

namespace {

const settings::Range kAny{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), ""};
constexpr std::int64_t kFormat = 1;

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + settings::numberText(value);
  return "[" + text + "]\n";
}

}  // namespace

std::string stateText(const RigState& state) {
  std::string text = "# What a simulated rig remembers; simulate --state goes on from it.\nrig_state: " +
                     std::to_string(kFormat) + "\norigin_ns: " + std::to_string(state.origin_ns) +
                     "\ntime: " + settings::numberText(state.time) +
                     "\nscans: " + std::to_string(state.scans) + "\nmount: " + std::to_string(state.mount) +
                     "\nsurface: " + settings::quotedText(state.surface) + "\ngas: " + list(state.gas) +
                     "sheet:\n";
  for (const auto& [id, values] : state.sheet) text += "  " + id + ": " + list(values);
  return text;
}

RigState readRigState(const settings::Settings& settings) {
  settings.integer("rig_state", {kFormat, kFormat, ""});
  RigState state;
  state.origin_ns = settings.integer("origin_ns", {0, 9e18, "ns"});
  state.time = settings.number("time", {0, 1e12, "s"});
  state.scans = static_cast<std::uint64_t>(settings.integer("scans", {0, 9e15, ""}));
  state.mount = static_cast<std::uint32_t>(settings.integer("mount", {0, 4294967295.0, ""}));
  state.surface = settings.text("surface");
  state.gas = settings.numbers("gas", kAny);
  const settings::Settings sheet = settings.section("sheet");
  for (const std::string& id : sheet.keys()) state.sheet[id] = sheet.numbers(id, kAny);
  settings.refuseUnknown();
  return state;
}

}  // namespace fsr::simulation
