#include "calibration/correction/recheck.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "calibration/correction/corrected_calibration.h"
#include "calibration/sources.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

std::string kilopascals(double value) {
  return settings::fixedText(value / 1000, 1) + " kPa";
}

// What another mount alone changes, beside the error within a mount [Pa].
double mountError(const CalibrationScores& scores) {
  if (scores.remount.readings == 0) return std::numeric_limits<double>::quiet_NaN();
  const double within = scores.whole.errors.whole.all.rmse, another = scores.remount.rmse;
  return std::sqrt(std::max(0.0, another * another - within * within));
}

// Empty = the correction is worth a child; else why it is not.
std::string whyNot(const Recheck& recheck, const RecheckOptions& options) {
  const CorrectionChoice& choice = recheck.choice;
  const double before = choice.rmse[0];
  if (choice.model == ChangeModel::kNone)
    return "no correction predicts cycles that were left out better than the calibration as it is";
  if (!(choice.p < options.error_rate)) {
    return "the gain of a correction on cycles that were left out may be chance (p = " +
           settings::roundedText(choice.p, 2) + ", needed: " + settings::roundedText(options.error_rate, 2) +
           ")";
  }
  if (!(before > options.worth * choice.nested)) {
    return "a correction would lower the error from " + kilopascals(before) + " to " +
           kilopascals(choice.nested) + " only, less than " + settings::fixedText(options.worth, 1) +
           " times";
  }
  const boost::math::normal normal;
  const double times = boost::math::quantile(normal, 1 - options.error_rate / 2);
  if (!std::isnan(recheck.mount) && !(recheck.removed > times * recheck.mount)) {
    return "what a correction would take away, " + kilopascals(recheck.removed) +
           ", may be this mount alone: mounts of the training differ by " + kilopascals(recheck.mount);
  }
  return "";
}

Correction correctionOf(const Calibration& parent, const Recheck& recheck,
                        const std::vector<dataset::Recording>& recordings, const std::string& date) {
  CalibrationOptions dated;
  dated.date = date;
  const Provenance now = provenanceOf(recordings, dated);
  Correction correction;
  correction.parent = parent.id;
  correction.parent_date = parent.provenance.date;
  correction.date = now.date;
  correction.tool_version = now.tool_version;
  correction.by_taxel = recheck.choice.model == ChangeModel::kTaxels;
  for (const ReadingChange& change : recheck.choice.changes) {
    correction.gain.push_back(change.gain);
    correction.offset.push_back(change.offset);
  }
  correction.surfaces = recheck.surfaces;
  correction.bags = now.bags;
  correction.cycles = recheck.cycles;
  correction.expected_rmse = recheck.choice.expected;
  correction.rmse_before = recheck.choice.rmse[0];
  correction.rmse = recheck.choice.nested;
  return correction;
}

void makeChild(const Calibration& parent, const std::vector<dataset::Recording>& recordings,
               const RecheckOptions& options, Recheck& recheck) {
  const CorrectionChoice& choice = recheck.choice;
  const double larger = std::max(1.0, choice.nested / choice.expected);
  recheck.child = movedCalibration(parent, choice.changes, larger);
  recheck.child->correction = correctionOf(parent, recheck, recordings, options.date);
  recheck.reasons.push_back("on cycles that were left out, the correction lowers the error from " +
                            kilopascals(choice.rmse[0]) + " to " + kilopascals(choice.nested) +
                            " (p = " + settings::roundedText(choice.p, 2) + ")");
}

// Judges the parent or its child with the limits of `train --check`.
void judge(const Calibration& best, const std::vector<dataset::Recording>& recordings,
           const RecheckOptions& options, Recheck& recheck) {
  recheck.check = checkCalibration(best, recordings, options.check);
  const CorrectionChoice& choice = recheck.choice;
  const double held_out = recheck.child ? choice.nested : choice.rmse[0];
  std::vector<std::string> reasons = recheck.check.reasons;
  // The deviations of a child have grown with its error, so it is compared with those of the parent.
  if (held_out > options.check.rmse_ratio * choice.expected) {
    reasons.insert(reasons.begin(), "the error on cycles that were left out is " + kilopascals(held_out) +
                                        ", more than " + settings::fixedText(options.check.rmse_ratio, 1) +
                                        " times the expected " + kilopascals(choice.expected));
  }
  if (reasons.empty()) return;
  recheck.verdict = RecheckVerdict::kRecalibrate;
  recheck.child.reset();
  recheck.reasons.insert(recheck.reasons.begin(), reasons.begin(), reasons.end());
}

}  // namespace

std::string verdictName(RecheckVerdict verdict) {
  switch (verdict) {
    case RecheckVerdict::kStillGood:
      return "still good";
    case RecheckVerdict::kCorrected:
      return "corrected";
    case RecheckVerdict::kRecalibrate:
      return "recalibrate";
  }
  return "";
}

void requireTrained(const Calibration& parent) {
  if (!parent.correction.present()) return;
  throw settings::InputError("calibration " + parent.id + " is itself a correction of " +
                             parent.correction.parent +
                             "; correct that one again with the new bags, or train anew");
}

Recheck recheckCalibration(const Calibration& parent, const std::vector<dataset::Recording>& recordings,
                           const RecheckOptions& options) {
  requireTrained(parent);
  const RecheckReadings readings = gatherRecheck(parent, recordings);
  Recheck recheck;
  recheck.choice = chooseCorrection(readings);
  recheck.cycles = readings.cycles();
  recheck.surfaces = readings.surfaces;
  recheck.remarks = readings.remarks;
  recheck.mount = mountError(parent.scores);
  const double before = recheck.choice.rmse[0], after = recheck.choice.nested;
  recheck.removed = std::sqrt(std::max(0.0, before * before - after * after));
  const std::string why_not = whyNot(recheck, options);
  if (why_not.empty()) {
    recheck.verdict = RecheckVerdict::kCorrected;
    makeChild(parent, recordings, options, recheck);
  } else {
    recheck.reasons.push_back(why_not);
  }
  judge(recheck.child ? *recheck.child : parent, recordings, options, recheck);
  if (recheck.child && std::isnan(recheck.mount)) {
    recheck.remarks.push_back(
        "the calibration was trained on one mount of each surface, so that it cannot tell a change of the "
        "sheet from one of its mount; recheck on another mount before you use the correction on others");
  }
  return recheck;
}

}  // namespace fsr::calibration
