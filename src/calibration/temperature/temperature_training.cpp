#include "calibration/temperature/temperature_training.h"

#include <algorithm>
#include <cmath>

#include "calibration/held_out_scoring.h"
#include "calibration/history_folds.h"
#include "calibration/temperature/temperature_course.h"
#include "calibration/temperature/temperature_fit.h"
#include "compensation/temperature_state.h"
#include "dataset/protocols.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

using compensation::TemperatureModel;

// Each recording is a group.
dataset::Protocols eachRecording(const std::vector<dataset::Recording>& recordings,
                                 const dataset::Protocols& protocols) {
  dataset::Protocols groups;
  groups.longest_hold = protocols.longest_hold;
  groups.highest = protocols.highest;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    groups.names.push_back("recording " +
                           (recordings[r].name.empty() ? std::to_string(r + 1) : recordings[r].name));
    groups.of_scan.emplace_back(recordings[r].scans(), static_cast<std::uint32_t>(r));
  }
  return groups;
}

// Groups that are left out, with the estimates of each lag.
struct Trial {
  dataset::Protocols groups;
  std::vector<TemperatureEstimate> estimates;  // [lags]
};

class TemperatureTraining {
 public:
  TemperatureTraining(const HistoryProblem& problem, const CalibrationOptions& options,
                      Calibration& calibration)
      : problem_(problem),
        options_(options),
        calibration_(calibration),
        grid_(temperatureGrid(problem.recordings, problem.sections)) {}

  TemperatureModel choose();

 private:
  TemperatureScore& score() { return calibration_.scores.temperature; }
  bool told(const std::string& why) {
    score().choice = "Temperature: none, since " + why + ".";
    return false;
  }
  void addTrial(dataset::Protocols groups);
  bool findLag();
  TemperatureModel model() const;
  bool wins(const TemperatureModel& model);
  bool winsOn(const Trial& trial, const TemperatureModel& model);

  const HistoryProblem& problem_;
  const CalibrationOptions& options_;
  Calibration& calibration_;
  const TemperatureGrid grid_;
  std::vector<Trial> trials_;
  std::size_t lag_ = 0;  // place in the grid
};

void TemperatureTraining::addTrial(dataset::Protocols groups) {
  if (groups.names.size() < 2) return;
  auto estimates = fitTemperature(problem_, grid_, groups, calibration_.no_model, options_.threads);
  // Where each surface has one group only, nothing can be predicted without it.
  if (!(estimates.front().square_without_temperature > 0)) return;
  trials_.push_back({std::move(groups), std::move(estimates)});
}

bool TemperatureTraining::findLag() {
  const dataset::Protocols protocols = dataset::protocolsOf(problem_.recordings, problem_.sections);
  addTrial(protocols);
  addTrial(eachRecording(problem_.recordings, protocols));
  if (trials_.empty())
    return told(
        "no protocol and no recording can be left out; record each surface with two paces and dwells, or in "
        "two bags");
  double least = 0;
  bool found = false;
  for (std::size_t l = 0; l < grid_.lags.size(); ++l) {
    double share = 0;  // of the squares without temperature
    for (const Trial& trial : trials_)
      share += trial.estimates[l].square / trial.estimates[l].square_without_temperature;
    if (!(share < double(trials_.size())) || (found && share >= least)) continue;
    least = share;
    lag_ = l;
    found = true;
  }
  return found || told("it does not explain readings that were left out");
}

TemperatureModel TemperatureTraining::model() const {
  TemperatureModel model{trials_.front().estimates[lag_].sensitivity,
                         grid_.reference,
                         grid_.lags[lag_],
                         grid_.low,
                         grid_.high,
                         0};
  double square = 0, scans = 0;
  for (const dataset::Recording& recording : problem_.recordings) {
    for (const double sheet : sheetTemperature(recording, model.lag)) {
      square += (sheet - model.reference) * (sheet - model.reference);
      scans += 1;
    }
  }
  model.spread = std::sqrt(square / scans);
  return model;
}

// The tables of the answer with temperature are trained at T_0 with the sensitivity of all groups. The factor
// of a group that is left out has the sensitivity that was found without it.
bool TemperatureTraining::winsOn(const Trial& trial, const TemperatureModel& model) {
  const std::vector<dataset::Recording> adjusted = atReference(problem_.recordings, model);
  std::vector<std::vector<double>> judged;
  for (std::size_t r = 0; r < adjusted.size(); ++r) {
    judged.push_back(adjusted[r].pressure);
    const std::vector<double> sheet = sheetTemperature(problem_.recordings[r], model.lag);
    for (std::size_t i = 0; i < sheet.size(); ++i) {
      const std::uint32_t group = trial.groups.of_scan[r][i];
      if (group == dataset::Protocols::kOther) continue;
      TemperatureModel own = model;
      own.sensitivity = trial.estimates[lag_].without[group];
      judged.back()[i] = problem_.recordings[r].pressure[i] / compensation::temperatureFactor(own, sheet[i]);
    }
  }
  const HistoryProblem at_reference{adjusted,           problem_.classes, problem_.sections, problem_.plan,
                                    problem_.regressor, problem_.zeros,   problem_.sessions};
  const auto before = familyErrors(HistoryFolds(problem_, trial.groups, options_.threads, calibration_));
  const auto after =
      familyErrors(HistoryFolds(at_reference, trial.groups, options_.threads, calibration_, judged));
  const auto family = std::size_t(calibration_.history.family);
  double square_before = 0, square_after = 0;
  bool nowhere_worse = true;
  for (std::size_t g = 0; g < before.size(); ++g) {
    const double without = before[g].rmse[family], with = after[g].rmse[family];
    score().groups.push_back({before[g].name, without, with});
    nowhere_worse = nowhere_worse && with <= kWorse * without;
    square_before += without * without;
    square_after += with * with;
  }
  if (!nowhere_worse)
    return told("with it the answer is worse by more than 1 % on a protocol or recording that was left out");
  return square_after <= kWins * kWins * square_before ||
         told("with it the answer is not better by 2 % on protocols and recordings that were left out");
}

bool TemperatureTraining::wins(const TemperatureModel& model) {
  bool wins = true;
  for (const Trial& trial : trials_) wins = winsOn(trial, model) && wins;
  return wins;
}

TemperatureModel TemperatureTraining::choose() {
  if (grid_.lags.empty()) {
    told("the mean temperatures of the cycles differ by " + settings::roundedText(kLeastTemperatureSpan) +
         " K or less");
    return {};
  }
  if (!findLag()) return {};
  const TemperatureModel chosen = model();
  if (!wins(chosen)) return {};
  score().choice = "Temperature: " + settings::roundedText(100 * chosen.sensitivity, 3) +
                   " % a kelvin with a lag of " + settings::roundedText(chosen.lag, 3) +
                   " s; it wins on protocols and recordings that were left out.";
  return chosen;
}

}  // namespace

TemperatureModel chooseTemperature(const HistoryProblem& problem, const CalibrationOptions& options,
                                   Calibration& calibration) {
  if (!options.temperature || !haveTemperature(problem.recordings)) return {};
  return TemperatureTraining(problem, options, calibration).choose();
}

}  // namespace fsr::calibration
