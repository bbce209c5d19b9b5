#include "calibration/correction/recheck.h"

#include <algorithm>
#include <cmath>

#include "calibration/correction/corrected_calibration.h"
#include "calibration/sources.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

// Empty = the correction is worth a child; else why it is not.
std::string whyNot(const CorrectionChoice& choice, const RecheckOptions& options) {
  const double before = choice.rmse[0];
  if (choice.model == ChangeModel::kNone)
    return "no correction predicts cycles that were left out better than the calibration as it is";
  if (!(choice.p < options.error_rate)) {
    return "the gain of a correction on cycles that were left out may be chance (p = " +
           settings::roundedText(choice.p, 2) + ", needed: " + settings::roundedText(options.error_rate, 2) +
           ")";
  }
  if (!(before > options.worth * choice.nested)) {
    return "a correction would lower the error from " + settings::fixedKilopascals(before, 1) + " to " +
           settings::fixedKilopascals(choice.nested, 1) + " only, less than " +
           settings::fixedText(options.worth, 1) + " times";
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
  recheck.verdict = RecheckVerdict::kCorrected;
  recheck.reasons = {"on cycles that were left out, the correction lowers the error from " +
                     settings::fixedKilopascals(choice.rmse[0], 1) + " to " +
                     settings::fixedKilopascals(choice.nested, 1) +
                     " (p = " + settings::roundedText(choice.p, 2) + ")"};
}

// What the limits of `train --check` say against the parent or its child.
std::vector<std::string> faultsOf(const Calibration& best, const std::vector<dataset::Recording>& recordings,
                                  const RecheckOptions& options, Recheck& recheck) {
  recheck.check = checkCalibration(best, recordings, options.check);
  const CorrectionChoice& choice = recheck.choice;
  const double held_out = recheck.child ? choice.nested : choice.rmse[0];
  std::vector<std::string> faults = recheck.check.reasons;
  // The deviations of a child have grown with its error, so it is compared with those of the parent.
  if (held_out > options.check.rmse_ratio * choice.expected) {
    faults.insert(faults.begin(),
                  "the error on cycles that were left out is " + settings::fixedKilopascals(held_out, 1) +
                      ", more than " + settings::fixedText(options.check.rmse_ratio, 1) +
                      " times the expected " + settings::fixedKilopascals(choice.expected, 1));
  }
  return faults;
}

void recalibrate(const std::vector<std::string>& faults, Recheck& recheck) {
  recheck.verdict = RecheckVerdict::kRecalibrate;
  recheck.child.reset();
  recheck.reasons.insert(recheck.reasons.begin(), faults.begin(), faults.end());
}

// Whether the deviations of the calibration contain the scatter of mounts.
bool statesMounts(const Calibration& parent) {
  return parent.scores.remount.readings > 0;
}

// Whether errors beyond the limits may be those of new mounts, which the calibration does not state.
bool mountsMayExplain(const Calibration& parent, const CorrectionFit& fit, const RecheckOptions& options,
                      const Recheck& recheck) {
  if (options.same_mount || statesMounts(parent)) return false;
  if (!recheck.check.dead.empty() || !recheck.check.stuck.empty()) return false;
  return errorWithinMounts(fit) <= options.check.rmse_ratio * recheck.choice.expected;
}

std::string mayBeMounts(const CommonChange& change, const RecheckOptions& options) {
  return settings::fixedKilopascals(change.size, 1) + ", may be the mounts alone: they scatter by " +
         settings::fixedKilopascals(change.scatter.deviation, 1) +
         " (p = " + settings::roundedText(change.p, 3) + ", needed: below " +
         settings::roundedText(options.mount_error_rate, 2) + ")";
}

// The sentence of a correction that mounts may explain.
std::string undecided(const Recheck& recheck, const RecheckOptions& options) {
  const CommonChange& sheet = recheck.mounts->sheet;
  if (sheet.scatter.known()) {
    return "what the mounts have in common, " + mayBeMounts(sheet, options) +
           "; record more new mounts and give all the bags";
  }
  const CorrectionChoice& choice = recheck.choice;
  const std::string before = settings::fixedKilopascals(choice.rmse[0], 1);
  return (choice.model == ChangeModel::kNone
              ? "the error is " + before + ", expected: " + settings::fixedKilopascals(choice.expected, 1)
              : "a correction would lower the error from " + before + " to " +
                    settings::fixedKilopascals(choice.nested, 1)) +
         ", but one new mount cannot be told from a change of the sheet, because the training had one mount "
         "of each surface, too; record two more new mounts with mount numbers of their own and give all the "
         "bags, or say that the sheet was not taken out since the training (--same-mount, same_mount:=true)";
}

void leaveUndecided(const Calibration& parent, const std::vector<dataset::Recording>& recordings,
                    const RecheckOptions& options, const std::string& reason, Recheck& recheck) {
  recheck.child.reset();
  recheck.reasons = {reason};
  recheck.verdict = RecheckVerdict::kCannotTell;
  const std::vector<std::string> faults = faultsOf(parent, recordings, options, recheck);
  if (!statesMounts(parent)) return;
  recheck.verdict = RecheckVerdict::kStillGood;
  if (!faults.empty()) recalibrate(faults, recheck);
}

// A correction wins, and there are mounts that the training did not have.
void decideOnMounts(const Calibration& parent, const std::vector<dataset::Recording>& recordings,
                    const CorrectionFit& fit, const RecheckOptions& options, Recheck& recheck) {
  recheck.mounts = testMounts(parent, fit.readings(), fit);
  if (!(recheck.mounts->sheet.p < options.mount_error_rate)) {
    leaveUndecided(parent, recordings, options, undecided(recheck, options), recheck);
    return;
  }
  const CommonChange& taxels = recheck.mounts->taxels;
  if (recheck.choice.model != ChangeModel::kTaxels || taxels.p < options.mount_error_rate) return;
  const CorrectionChoice sheet = chooseCorrection(fit, ChangeModel::kSheet);
  const std::string why_not = whyNot(sheet, options);
  const std::string reason = "what taxels differ by from the whole sheet, " + mayBeMounts(taxels, options);
  if (!why_not.empty()) {
    leaveUndecided(parent, recordings, options, why_not + "; " + reason + "; record more new mounts",
                   recheck);
    return;
  }
  recheck.remarks.push_back(reason + "; all taxels are corrected alike");
  recheck.choice = sheet;
  makeChild(parent, recordings, options, recheck);
  recheck.check = checkCalibration(*recheck.child, recordings, options.check);
}

void requireOneMount(const RecheckReadings& readings) {
  for (const RecheckReadings::Stay& one : readings.stays) {
    for (const RecheckReadings::Stay& other : readings.stays) {
      if (one.surface != other.surface || one.mount == other.mount) continue;
      throw settings::InputError(
          "same mount says that the sheet was not taken out since the training, but the "
          "bags have mounts " +
          std::to_string(one.mount) + " and " + std::to_string(other.mount) + " of " +
          readings.surfaces[one.surface] + "; leave it out, or give one mount");
    }
  }
}

}  // namespace

std::string verdictName(RecheckVerdict verdict) {
  switch (verdict) {
    case RecheckVerdict::kStillGood:
      return "still good";
    case RecheckVerdict::kCorrected:
      return "corrected";
    case RecheckVerdict::kCannotTell:
      return "cannot tell";
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
  if (options.same_mount) requireOneMount(readings);
  const CorrectionFit fit(readings);
  Recheck recheck;
  recheck.choice = chooseCorrection(fit);
  recheck.cycles = readings.cycles();
  recheck.surfaces = readings.surfaces;
  recheck.remarks = readings.remarks;
  const std::string why_not = whyNot(recheck.choice, options);
  recheck.reasons = {why_not};
  if (why_not.empty()) makeChild(parent, recordings, options, recheck);
  const std::vector<std::string> faults =
      faultsOf(recheck.child ? *recheck.child : parent, recordings, options, recheck);
  const CalibrationCheck of_parent =
      recheck.child ? checkCalibration(parent, recordings, options.check) : recheck.check;
  recheck.expected = of_parent.whole.expected_rmse;
  const bool explained = !faults.empty() && mountsMayExplain(parent, fit, options, recheck);
  if (!faults.empty() && !explained) {
    recalibrate(faults, recheck);
  } else if (recheck.child && !options.same_mount) {
    decideOnMounts(parent, recordings, fit, options, recheck);
  } else if (explained) {
    recheck.mounts = testMounts(parent, readings, fit);
    const bool changed = recheck.mounts->sheet.p < options.mount_error_rate;
    leaveUndecided(parent, recordings, options,
                   changed ? why_not + "; record more new mounts" : undecided(recheck, options), recheck);
  }
  return recheck;
}

}  // namespace fsr::calibration
