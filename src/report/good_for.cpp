#include "report/good_for.h"

#include <algorithm>

#include "calibration/budget/new_mount_line.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

std::string nextStep(const calibration::CalibrationCheck& check) {
  if (!check.still_good)
    return "ask train --correct whether gain and offset are enough, or train again with these bags";
  return check.not_shown.empty() ? "use it" : "use it, and check it on bags that show the rest";
}

}  // namespace

std::string goodForText(const calibration::Calibration& calibration) {
  const std::string note = calibration::newMountNote(calibration.budget);
  return "Good for: " + (note.empty() ? "not known, because scores were not computed; next: train on all the "
                                        "bags without --no-scores"
                                      : note);
}

std::string goodForText(const calibration::CalibrationCheck& check) {
  const auto worst = std::max_element(check.bags.begin(), check.bags.end(),
                                      [](const auto& a, const auto& b) { return a.rmse < b.rmse; });
  const std::string bag = worst == check.bags.end() ? ""
                                                    : "; worst bag: " + worst->name + ", RMSE " +
                                                          settings::fixedText(worst->rmse / 1e3, 1) + " kPa";
  return "Good for: 68 % of the readings of these bags err by at most " +
         calibration::errorText(check.within[0], check.range) + " and 95 % by at most " +
         calibration::errorText(check.within[1], check.range) + bag + "; next: " + nextStep(check);
}

}  // namespace fsr::report
