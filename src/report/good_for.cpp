#include "report/good_for.h"

#include "calibration/budget/new_mount_line.h"

namespace fsr::report {

std::string goodForText(const calibration::Calibration& calibration) {
  const std::string note = calibration::newMountNote(calibration.budget);
  return "Good for: " + (note.empty() ? "not known, because scores were not computed; next: train on all the "
                                        "bags without --no-scores"
                                      : note);
}

}  // namespace fsr::report
