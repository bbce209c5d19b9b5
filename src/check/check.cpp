#include "check/check.h"

#include <algorithm>
#include <cmath>

#include "calibration/sources.h"
#include "check/correction.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::check {

namespace {

using calibration::Calibration;
using dataset::Recording;
using settings::fixedPressure;
using settings::roundedText;

constexpr double kTareGain = 0.02;  // share of the error, from which on a tare is worth a sentence
// Probability of taking a correction that gains nothing on cycles that were left out (one-sided), and of
// taking one where only the mounts differ.
constexpr double kErrorRate = 0.01, kMountErrorRate = 0.05;
constexpr double kWorth = 1.1;  // times the correction's RMSE, to which the parent is still good

// Empty = the correction is worth a child; else why it is not.
std::string whyNot(const CorrectionChoice& choice) {
  const double before = choice.rmse[0];
  if (choice.model == ChangeModel::kNone)
    return "no correction predicts cycles that were left out better than the calibration as it is";
  if (!(choice.p < kErrorRate)) {
    return "the gain of a correction on cycles that were left out may be chance (p = " +
           roundedText(choice.p, 2) + ", needed: " + roundedText(kErrorRate, 2) + ")";
  }
  if (!(before > kWorth * choice.nested)) {
    return "a correction would lower the error from " + fixedPressure(before, 1) + " to " +
           fixedPressure(choice.nested, 1) + " only, less than " + settings::fixedText(kWorth, 1) + " times";
  }
  return "";
}

std::string mayBeMounts(const CommonChange& change) {
  return fixedPressure(change.size, 1) + ", may be the mounts alone: they scatter by " +
         fixedPressure(change.scatter.deviation, 1) + " (p = " + roundedText(change.p, 3) +
         ", needed: below " + roundedText(kMountErrorRate, 2) + ")";
}

// The sentence of a correction that mounts may explain.
std::string undecided(const CorrectionCheck& correction) {
  const CommonChange& sheet = correction.mounts->sheet;
  if (sheet.scatter.known()) {
    return "what the mounts have in common, " + mayBeMounts(sheet) +
           "; record more new mounts and give all the bags";
  }
  const CorrectionChoice& choice = correction.choice;
  const std::string before = fixedPressure(choice.rmse[0], 1);
  return (choice.model == ChangeModel::kNone
              ? "the error is " + before + ", expected: " + fixedPressure(choice.expected, 1)
              : "a correction would lower the error from " + before + " to " +
                    fixedPressure(choice.nested, 1)) +
         ", but one new mount cannot be told from a change of the sheet, because the training had one mount "
         "of each surface, too; record two more new mounts with mount numbers of their own and give all the "
         "bags, or say that the sheet was not taken out since the training (--same-mount, same_mount:=true)";
}

void requireOneMount(const CycleReadings& readings) {
  for (const CycleReadings::Stay& one : readings.stays) {
    for (const CycleReadings::Stay& other : readings.stays) {
      if (one.surface != other.surface || one.mount == other.mount) continue;
      throw settings::InputError(
          "same mount says that the sheet was not taken out since the training, but the "
          "bags have mounts " +
          std::to_string(one.mount) + " and " + std::to_string(other.mount) + " of " +
          readings.surfaces[one.surface] + "; leave it out, or give one mount");
    }
  }
}

// Decides on a correction of a calibration whose map was checked.
class CorrectionDecision {
 public:
  CorrectionDecision(const Calibration& parent, const std::vector<Recording>& recordings,
                     const CheckOptions& options, CheckResult& result)
      : parent_(parent),
        recordings_(recordings),
        options_(options),
        readings_(gatherCycles(parent, recordings)),
        fit_(readings_),
        of_parent_(result.map),
        result_(result),
        correction_(result.correction.emplace()) {
    if (options.same_mount) requireOneMount(readings_);
  }

  void run() {
    correction_.choice = chooseCorrection(fit_);
    correction_.expected = of_parent_.whole.expectedRmse();
    correction_.cycles = readings_.cycles();
    correction_.surfaces = readings_.surfaces;
    correction_.remarks = readings_.remarks;
    result_.verdict = Verdict::kStillGood;
    const std::string why_not = whyNot(correction_.choice);
    result_.reasons = {why_not};
    if (why_not.empty()) makeChild();
    const std::vector<std::string> faults = faultsOf();
    const bool explained = !faults.empty() && mountsMayExplain();
    if (!faults.empty() && !explained) {
      recalibrate(faults);
    } else if (result_.child && !options_.same_mount) {
      decideOnMounts();
    } else if (explained) {
      correction_.mounts = testMounts(parent_, fit_);
      const bool changed = correction_.mounts->sheet.p < kMountErrorRate;
      leaveUndecided(changed ? why_not + "; record more new mounts" : undecided(correction_));
    }
  }

 private:
  void makeChild() {
    const CorrectionChoice& choice = correction_.choice;
    const double larger = std::max(1.0, choice.nested / choice.expected);
    result_.child = movedCalibration(parent_, choice.changes, larger);
    describeChild(result_.child->correction);
    result_.verdict = Verdict::kCorrected;
    result_.reasons = {"on cycles that were left out, the correction lowers the error from " +
                       fixedPressure(choice.rmse[0], 1) + " to " + fixedPressure(choice.nested, 1) +
                       " (p = " + roundedText(choice.p, 2) + ")"};
    result_.map = errorsOfMap(*result_.child, recordings_, options_.limits);
  }

  void describeChild(calibration::Correction& child) const {
    calibration::CalibrationOptions dated;
    dated.date = options_.date;
    const calibration::Provenance now = calibration::provenanceOf(recordings_, dated);
    const CorrectionChoice& choice = correction_.choice;
    child.parent = parent_.id;
    child.parent_date = parent_.provenance.date;
    child.date = now.date;
    child.tool_version = now.tool_version;
    child.by_taxel = choice.model == ChangeModel::kTaxels;
    for (const ReadingChange& change : choice.changes) {
      child.gain.push_back(change.gain);
      child.offset.push_back(change.offset);
    }
    child.surfaces = correction_.surfaces;
    child.bags = now.bags;
    child.cycles = correction_.cycles;
    child.expected_rmse = choice.expected;
    child.rmse_before = choice.rmse[0];
    child.rmse = choice.nested;
  }

  // What the limits say against the parent or its child.
  std::vector<std::string> faultsOf() const {
    const CorrectionChoice& choice = correction_.choice;
    const double held_out = result_.child ? choice.nested : choice.rmse[0];
    std::vector<std::string> faults = result_.map.faults;
    // The deviations of a child have grown with its error, so it is compared with those of the parent.
    if (held_out > options_.limits.rmse_ratio * choice.expected) {
      faults.insert(faults.begin(), "the error on cycles that were left out is " +
                                        fixedPressure(held_out, 1) + ", more than " +
                                        settings::fixedText(options_.limits.rmse_ratio, 1) +
                                        " times the expected " + fixedPressure(choice.expected, 1));
    }
    return faults;
  }

  void recalibrate(const std::vector<std::string>& faults) {
    result_.verdict = Verdict::kRecalibrate;
    result_.child.reset();
    result_.reasons.insert(result_.reasons.begin(), faults.begin(), faults.end());
  }

  // Whether the deviations of the calibration contain the scatter of mounts.
  bool statesMounts() const { return parent_.scores.remount.readings > 0; }

  // Whether errors beyond the limits may be those of new mounts, which the calibration does not state.
  bool mountsMayExplain() const {
    if (options_.same_mount || statesMounts()) return false;
    if (!result_.map.dead.empty() || !result_.map.stuck.empty()) return false;
    return errorWithinMounts(fit_) <= options_.limits.rmse_ratio * correction_.choice.expected;
  }

  void leaveUndecided(const std::string& reason) {
    result_.child.reset();
    result_.map = of_parent_;
    result_.reasons = {reason};
    result_.verdict = statesMounts() ? Verdict::kStillGood : Verdict::kCannotTell;
    const std::vector<std::string> faults = faultsOf();
    if (statesMounts() && !faults.empty()) recalibrate(faults);
  }

  // A correction wins, and there are mounts that the training did not have.
  void decideOnMounts() {
    correction_.mounts = testMounts(parent_, fit_);
    if (!(correction_.mounts->sheet.p < kMountErrorRate)) {
      leaveUndecided(undecided(correction_));
      return;
    }
    const CommonChange& taxels = correction_.mounts->taxels;
    if (correction_.choice.model != ChangeModel::kTaxels || taxels.p < kMountErrorRate) return;
    const CorrectionChoice sheet = chooseCorrection(fit_, ChangeModel::kSheet);
    const std::string why_not = whyNot(sheet);
    const std::string reason = "what taxels differ by from the whole sheet, " + mayBeMounts(taxels);
    if (!why_not.empty()) {
      leaveUndecided(why_not + "; " + reason + "; record more new mounts");
      return;
    }
    correction_.remarks.push_back(reason + "; all taxels are corrected alike");
    correction_.choice = sheet;
    makeChild();
  }

  const Calibration& parent_;
  const std::vector<Recording>& recordings_;
  const CheckOptions& options_;
  const CycleReadings readings_;
  const CorrectionFit fit_;
  const MapErrors of_parent_;
  CheckResult& result_;
  CorrectionCheck& correction_;
};

// Asks whether one tare at the start of each session is enough where the calibration expects none.
void adviseTare(const Calibration& calibration, const std::vector<Recording>& recordings,
                const CheckOptions& options, CheckResult& result) {
  Calibration tared = calibration;
  tared.session_zero.tare = calibration::SessionTare::kTablesAlone;
  const MapErrors map = errorsOfMap(tared, recordings, options.limits);
  std::vector<std::string>& remarks = result.map.remarks;
  remarks.insert(remarks.end(), map.not_tared.begin(), map.not_tared.end());
  const double before = map.rmse_without_tare, gain = 1 - map.whole.rmse() / before;
  if (!(gain >= kTareGain)) return;
  const std::string advice = "one tare takes " + settings::percentText(gain) + " off (from " +
                             settings::fixedText(before / 1000, 1) + " to " +
                             fixedPressure(map.whole.rmse(), 1) + ")";
  if (!map.faults.empty()) {
    remarks.push_back(advice + ", which is not enough");
    return;
  }
  result.verdict = Verdict::kTare;
  result.reasons = {advice};
}

}  // namespace

std::string verdictName(Verdict verdict) {
  constexpr const char* kNames[] = {"still good", "corrected", "cannot tell", "tare", "recalibrate"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::string correctionText(const calibration::Correction& correction) {
  if (!correction.present()) return "";
  return "corrected on " + correction.date.substr(0, 10) + " from " + correction.parent;
}

void requireTrained(const Calibration& parent) {
  if (!parent.correction.present()) return;
  throw settings::InputError("calibration " + parent.id + " is itself a correction of " +
                             parent.correction.parent +
                             "; correct that one again with the new bags, or train anew");
}

CheckResult check(const Calibration& calibration, const std::vector<Recording>& recordings,
                  const CheckOptions& options) {
  if (options.correct) requireTrained(calibration);
  CheckResult result;
  result.map = errorsOfMap(calibration, recordings, options.limits);
  result.reasons = result.map.faults;
  if (!result.reasons.empty()) result.verdict = Verdict::kRecalibrate;
  if (calibration.shape.present()) result.at_rest = calibration::checkShapes(calibration, recordings);
  if (options.correct) CorrectionDecision(calibration, recordings, options, result).run();
  if (result.verdict == Verdict::kRecalibrate && !calibration.session_zero.expected())
    adviseTare(calibration, recordings, options, result);
  return result;
}

}  // namespace fsr::check
