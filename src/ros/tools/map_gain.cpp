#include "ros/tools/map_gain.h"

#include <cmath>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/tools/history_option.h"
#include "settings/number_text.h"

namespace fsr_ros {

namespace {

using fsr::compensation::HistoryFamily;
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
           fsr::compensation::historyName(proposed) + " has an error of " +
           errorOf(score.protocols, proposed) + " kPa, the static one of " + still +
           " kPa. A model is used only where it wins over all of them and loses on none.";
  }
  return "On protocols that were left out, the error of the map falls from " + still + " to " +
         errorOf(score.protocols, chosen) + " kPa with a model of " + fsr::compensation::historyName(chosen) +
         ". train --history verdict.yaml BAG... uses it.";
}

}  // namespace

std::string mapGain(const std::vector<fsr::dataset::Recording>& recordings,
                    const std::vector<std::string>& effects, unsigned threads) {
  if (effects.empty()) return "";
  const HistoryFamily proposed = historyFamilyOf(effects);
  if (proposed == HistoryFamily::kNone)
    return "Nothing from this name: a calibration has no model of this effect.";
  fsr::calibration::CalibrationProblem problem{recordings, {}};
  problem.options.scores = false;
  problem.options.threads = threads;
  problem.options.history = {true, proposed};
  problem.options.zero = fsr::calibration::ZeroChoice::kNone;  // the gain is that of the history alone
  try {
    return gainOf(fsr::calibration::calibrate(problem), proposed);
  } catch (const fsr::settings::InputError& error) {
    return std::string("Not known, since no calibration can be trained on these bags: ") + error.what() + ".";
  }
}

}  // namespace fsr_ros
