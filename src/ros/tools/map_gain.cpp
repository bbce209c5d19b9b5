#include "ros/tools/map_gain.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr_ros {

namespace {

using fsr::calibration::HistoryFamily;
using Protocols = std::vector<fsr::calibration::HistoryScore::Protocol>;

constexpr double kKilopascal = 1e3;  // [Pa]

// Over all protocols, each with the same weight [kPa].
std::string errorOf(const Protocols& protocols, HistoryFamily family) {
  double sum = 0;
  for (const auto& protocol : protocols) {
    const double rmse = protocol.rmse[static_cast<std::size_t>(family)];
    sum += rmse * rmse;
  }
  return fsr::settings::fixedText(std::sqrt(sum / static_cast<double>(protocols.size())) / kKilopascal, 2);
}

std::string gainOf(const fsr::calibration::Calibration& calibration, HistoryFamily proposed) {
  const fsr::calibration::HistoryScore& score = calibration.scores.history;
  const HistoryFamily chosen = calibration.history.family;
  if (score.protocols.empty()) return "Not known. " + score.choice;
  const std::string still = errorOf(score.protocols, HistoryFamily::kNone);
  if (chosen == HistoryFamily::kNone) {
    return "Nothing. On protocols that were left out, a calibration with a model of " +
           fsr::calibration::historyName(proposed) + " has an error of " +
           errorOf(score.protocols, proposed) + " kPa, the static one of " + still +
           " kPa. A model is used only where it wins over all of them and loses on none.";
  }
  return "On protocols that were left out, the error of the map falls from " + still + " to " +
         errorOf(score.protocols, chosen) + " kPa with a model of " + fsr::calibration::historyName(chosen) +
         ". train --history verdict.yaml BAG... uses it.";
}

std::string temperatureGain(const fsr::calibration::Calibration& calibration) {
  const fsr::calibration::TemperatureScore& score = calibration.scores.temperature;
  if (score.choice.empty()) return "A model of the temperature needs a thermometer in all bags.";
  if (!calibration.temperature.present()) return score.choice;
  double without = 0, with = 0;
  for (const auto& group : score.groups) {
    without += group.without * group.without;
    with += group.with * group.with;
  }
  const double groups = static_cast<double>(score.groups.size());
  return "On protocols and recordings that were left out, the error of readings predicted from the pressure "
         "falls from " +
         fsr::settings::fixedText(std::sqrt(without / groups) / kKilopascal, 2) + " to " +
         fsr::settings::fixedText(std::sqrt(with / groups) / kKilopascal, 2) +
         " kPa with a factor for the temperature. train uses it unless --temperature none is given.";
}

// Halves the counts until they have twelve bits at most. A regression's table has an entry for each count, so
// a board of sixteen bits would take sixteen times as long, for errors that are far above a count.
void coarsen(std::vector<fsr::dataset::Recording>& recordings) {
  constexpr int kFinest = 4095;  // full scale [counts]
  for (const fsr::dataset::Recording& recording : recordings) {
    if (recording.count_file) return;  // a long one, whose counts are not in memory
  }
  for (fsr::dataset::Recording& recording : recordings) {
    int bits = 0;
    while (recording.full_scale >> bits > kFinest) ++bits;
    recording.full_scale = static_cast<std::uint16_t>(recording.full_scale >> bits);
    for (std::uint16_t& count : recording.counts) count = static_cast<std::uint16_t>(count >> bits);
  }
}

}  // namespace

HistoryFamily historyFamilyOf(const std::vector<std::string>& effects) {
  bool plays = false, memories = false;
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    if (std::find(effects.begin(), effects.end(), entry.info.id) == effects.end()) continue;
    plays |= dependsOn(entry.info, fsr::simulation::Covariate::kPreviousExtremes);
    memories |= dependsOn(entry.info, fsr::simulation::Covariate::kTimeSinceReversal);
  }
  if (plays && memories) return HistoryFamily::kBoth;
  if (plays) return HistoryFamily::kPlays;
  return memories ? HistoryFamily::kMemories : HistoryFamily::kNone;
}

std::string mapGain(const std::vector<fsr::dataset::Recording>& recordings,
                    const std::vector<std::string>& effects, unsigned threads) {
  if (effects.empty()) return "";
  const HistoryFamily proposed = historyFamilyOf(effects);
  const bool temperature = std::find(effects.begin(), effects.end(), "temperature") != effects.end();
  const bool memory = proposed != HistoryFamily::kNone;
  if (!memory && !temperature) return "Nothing from this name: a calibration has no model of this effect.";
  fsr::calibration::CalibrationProblem problem{recordings, {}};
  coarsen(problem.recordings);
  problem.options.scores = false;
  problem.options.threads = threads;
  problem.options.zero = fsr::calibration::ZeroChoice::kNone;  // the gain is that of the history alone
  problem.options.history = {memory, proposed};
  problem.options.temperature = temperature;
  try {
    const fsr::calibration::Calibration calibration = fsr::calibration::calibrate(problem);
    if (!temperature) return gainOf(calibration, proposed);
    return (memory ? gainOf(calibration, proposed) + " " : "") + temperatureGain(calibration);
  } catch (const fsr::settings::InputError& error) {
    return std::string("Not known, since no calibration can be trained on these bags: ") + error.what() + ".";
  }
}

}  // namespace fsr_ros
