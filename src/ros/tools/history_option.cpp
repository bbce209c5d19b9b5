#include "ros/tools/history_option.h"

#include <algorithm>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "settings/joined.h"
#include "simulation/effects/effect_library.h"

namespace fsr_ros {

namespace {

using fsr::calibration::HistoryFamily;
using fsr::simulation::Covariate;

std::string listed(const std::vector<std::string>& effects) {
  return effects.empty() ? "no effect" : fsr::settings::joined(effects);
}

}  // namespace

HistoryFamily historyFamilyOf(const std::vector<std::string>& effects) {
  bool plays = false, memories = false;
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    if (std::find(effects.begin(), effects.end(), entry.info.id) == effects.end()) continue;
    plays |= dependsOn(entry.info, Covariate::kPreviousExtremes);
    memories |= dependsOn(entry.info, Covariate::kTimeSinceReversal);
  }
  if (plays && memories) return HistoryFamily::kBoth;
  if (plays) return HistoryFamily::kPlays;
  return memories ? HistoryFamily::kMemories : HistoryFamily::kNone;
}

fsr::calibration::HistoryChoice historyOption(const std::string& text, std::string& remark) {
  if (text == "auto") return {};
  if (!std::filesystem::exists(text)) {
    try {
      return {false, fsr::calibration::historyFromName(text)};
    } catch (const fsr::settings::InputError&) {
      throw fsr::settings::InputError(
          "--history is \"" + text +
          "\", but must be auto, none, plays, memories, both, or the path of a verdict.yaml");
    }
  }
  const fsr::report::VerdictFile verdict = fsr::report::readVerdict(text);
  const HistoryFamily family = historyFamilyOf(verdict.effects);
  if (family == HistoryFamily::kNone) {
    remark = text + " names " + listed(verdict.effects) +
             ", which no model of memory describes; the history is chosen as with auto.";
  }
  return {true, family};
}

bool temperatureOption(const std::string& text, const fsr::calibration::HistoryChoice& history) {
  if (text.empty()) return history.automatic || history.family != HistoryFamily::kNone;
  if (text == "auto" || text == "none") return text == "auto";
  throw fsr::settings::InputError("--temperature is \"" + text + "\", but must be auto or none");
}

}  // namespace fsr_ros
