#include "calibration/stages/deviation/new_mount_line.h"

#include <algorithm>
#include <cmath>

#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr const char* kNewMount = "a new mount";
constexpr double kStandsOut = 2;  // as k = 2 of the budget: the RMSE of a mount as a multiple of the others'

// Of all mounts but the worst, each with the same weight [Pa].
double rmseOfOthers(const std::vector<NewMountErrors::Mount>& mounts, const NewMountErrors::Mount& worst) {
  double squares = 0;
  for (const NewMountErrors::Mount& mount : mounts) {
    if (&mount != &worst) squares += mount.rmse * mount.rmse;
  }
  return std::sqrt(squares / static_cast<double>(mounts.size() - 1));
}

std::string memoryText(const Calibration& calibration) {
  if (!calibration.history.present() || calibration.scores.history.parts.empty()) return "";
  const HistoryScore::Part& all = calibration.scores.history.parts.front();
  return " before the sheet's memory is settled (with it, the RMSE on left-out protocols falls from " +
         settings::fixedPressure(all.static_rmse, 1) + " to " + settings::fixedPressure(all.rmse, 1) + ")";
}

// What to do where no mount stands out.
std::string nextStep(const Calibration& calibration) {
  const std::vector<std::string>& thin = calibration.coverage.thin;
  if (!thin.empty()) return "record what the bags lack: " + thin.front();
  return "use it, and check it on a new mount with check_calibration";
}

std::string mountsNote(const Calibration& calibration, const NewMountErrors& errors) {
  const std::vector<NewMountErrors::Mount>& mounts = errors.mounts;
  const auto worst = std::max_element(mounts.begin(), mounts.end(),
                                      [](const auto& a, const auto& b) { return a.rmse < b.rmse; });
  const double others = rmseOfOthers(mounts, *worst);
  const bool stands_out = worst->rmse > kStandsOut * others;
  const TrainedInterval& range = calibration.trained.pressure;
  return "on a new mount of a known surface 68 % of the readings err by at most " +
         errorText(errors.within[0], range) + " and 95 % by at most " + errorText(errors.within[1], range) +
         memoryText(calibration) + "; worst of " + std::to_string(mounts.size()) + " mounts: " + worst->name +
         ", RMSE " + settings::fixedPressure(worst->rmse, 1) + ", the others " +
         settings::fixedPressure(others, 1) + "; next: " +
         (stands_out
              ? "see whether that mount was as declared (check_bag), and leave it out or record it again"
              : nextStep(calibration));
}

std::string cyclesNote(const Calibration& calibration) {
  const auto& conditions = calibration.scores.conditions;
  const auto rmse = [](const ConditionScore& condition) { return condition.score.errors.whole.all.rmse; };
  const auto worst = std::max_element(conditions.begin(), conditions.end(),
                                      [&](const auto& a, const auto& b) { return rmse(a) < rmse(b); });
  return "not known on a new mount, because no surface was mounted more than once; 95 % of the readings of "
         "new "
         "cycles on the same mounts err by at most " +
         errorText(calibration.scores.whole.errors.whole.all.p95_absolute, calibration.trained.pressure) +
         "; worst surface: " + worst->condition.surface + ", RMSE " +
         settings::fixedPressure(rmse(*worst), 1) + "; next: record each surface on two mounts or more";
}

}  // namespace

BudgetLine newMountLine(const Calibration& calibration, const NewMountErrors& errors) {
  BudgetLine line;
  line.name = kNewMount;
  if (errors.mounts.size() > 1) {
    line.source = BudgetSource::kMeasured;
    line.note = mountsNote(calibration, errors);
  } else if (!calibration.scores.conditions.empty()) {
    line.note = cyclesNote(calibration);
  }
  return line;
}

std::string newMountNote(const ErrorBudget& budget) {
  for (const BudgetLine& line : budget.lines) {
    if (line.name == kNewMount) return line.note;
  }
  return "";
}

std::string errorText(double error, const TrainedInterval& range) {
  return settings::fixedPressure(error, 1) + " (" + settings::percentText(error / (range.high - range.low)) +
         " of the range)";
}

}  // namespace fsr::calibration
