#include "discrepancy/samples/admission.h"

#include <algorithm>
#include <cmath>

#include "calibration/sources.h"
#include "dataset/mounts.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::discrepancy {

namespace {

constexpr double kShareOfLooks = 0.2;  // of the time of an inspection, before the search for faults

std::string percentOf(double share) {
  return settings::percentText(share, share < 0.001 ? 3 : 1);
}

AdmittedRecording lookAt(const dataset::Recording& recording) {
  AdmittedRecording result;
  result.name = recording.name;
  result.scans = recording.scans();
  result.seconds = recording.scans() > 1 ? recording.time.back() - recording.time.front() : 0;
  result.surfaces = recording.conditions.size();
  result.chamber = !recording.pressure.empty();
  result.temperature = !recording.temperature.empty();
  result.losses = recording.losses;
  if (recording.scans() == 0) return result;
  result.health = health::recordingHealth(recording);
  result.lag = dataset::referenceLag(recording);
  return result;
}

void judgeLag(const AdmittedRecording& recording, const AdmissionOptions& options, Admission& admission) {
  if (!recording.chamber || recording.scans == 0) return;
  if (!recording.lag) {
    admission.problems.push_back(
        recording.name +
        ": the matrix does not follow the chamber (was it in it, and did the pressure move?)");
    return;
  }
  const double lag = recording.lag->seconds;
  if (std::abs(lag) <= options.lag) return;
  admission.problems.push_back(
      recording.name + ": the matrix answers " + settings::fixedText(std::abs(lag), 2) + " s " +
      (lag > 0 ? "later" : "earlier") + " than chamber_pressure says (allowed: " +
      settings::fixedText(options.lag, 2) + " s): do both stamps come from one clock?");
}

// A sheet cannot answer before its load, but a reference can be late.
void judgeLead(const AdmittedRecording& recording, const AdmissionOptions& options, Admission& admission) {
  if (!recording.lag || std::abs(recording.lag->seconds) > options.lag) return;  // see judgeLag()
  const double lead = -recording.lag->seconds;
  if (lead <= std::max(options.lead, recording.lag->step / 2)) return;
  admission.remarks.push_back(
      recording.name + ": the matrix answers " + settings::fixedText(lead, 2) +
      " s before chamber_pressure, which no sheet does: is the transducer filtered, at the "
      "end of a long tube, or stamped late?");
}

void judgeFaults(const AdmittedRecording& recording, std::size_t taxels, const AdmissionOptions& options,
                 Admission& admission) {
  const std::size_t failing = recording.health.dead.size() + recording.health.stuck.size();
  if (failing == 0) return;
  const std::string sentence = recording.name + ": " + std::to_string(failing) + " of " +
                               std::to_string(taxels) + " taxels are dead or stuck";
  const bool many = double(failing) > options.failing_share * double(taxels);
  if (many) admission.problems.push_back(sentence + ", more than " + percentOf(options.failing_share));
  if (!many) admission.remarks.push_back(sentence);
}

void judgeRest(const AdmittedRecording& recording, const AdmissionOptions& options, Admission& admission) {
  const auto lost = double(recording.losses.lost_scans);
  if (lost > options.lost_share * (lost + double(recording.scans))) {
    admission.remarks.push_back(recording.name + ": " + percentOf(lost / (lost + double(recording.scans))) +
                                " of the scans are lost (" + std::to_string(recording.losses.sequence_gaps) +
                                " gaps)");
  }
  if (recording.health.saturated > options.saturated_share) {
    admission.remarks.push_back(recording.name + ": " + percentOf(recording.health.saturated) +
                                " of the readings are at full scale");
  }
}

// The error message of `ask`; empty = it raises no InputError.
template <typename Ask>
std::string refusal(Ask ask) {
  try {
    ask();
    return "";
  } catch (const settings::InputError& error) {
    return error.what();
  }
}

// Why `train` would refuse the recordings.
std::string trainingRefusal(const std::vector<dataset::Recording>& recordings,
                            const AdmissionOptions& options) {
  calibration::CalibrationOptions training;
  training.folds = options.sections;
  return refusal([&] { calibration::validate(recordings, training); });
}

}  // namespace

std::vector<std::string> whyNotFit(const std::vector<dataset::Recording>& recordings,
                                   const AdmissionOptions& options) {
  Admission admission;
  const std::string training = trainingRefusal(recordings, options);
  if (!training.empty()) admission.problems.push_back(training);
  for (const dataset::Recording& recording : recordings) {
    const AdmittedRecording looked = lookAt(recording);
    judgeLag(looked, options, admission);
    judgeFaults(looked, recording.layout.size.taxels(), options, admission);
  }
  return admission.problems;
}

Admission inspectRecordings(std::vector<dataset::Recording> recordings, const AdmissionOptions& options,
                            const DiscrepancyProgress& progress) {
  Admission admission;
  if (recordings.empty()) return admission;
  admission.layout = recordings.front().layout;
  for (const dataset::Recording& recording : recordings) {
    const auto before = static_cast<double>(admission.recordings.size());
    if (progress) progress("inspecting", kShareOfLooks * before / static_cast<double>(recordings.size()));
    const AdmittedRecording looked = lookAt(recording);
    judgeLag(looked, options, admission);
    judgeFaults(looked, recording.layout.size.taxels(), options, admission);
    judgeLead(looked, options, admission);
    judgeRest(looked, options, admission);
    for (const std::string& warning : recording.warnings) {
      admission.remarks.push_back(recording.name + ": " + warning);
    }
    admission.recordings.push_back(looked);
  }
  for (const dataset::MountRemark& remark : dataset::remarksOnDifferingMounts(recordings)) {
    (remark.certain() ? admission.mounts : admission.remarks).push_back(remark.sentence);
  }
  admission.training = trainingRefusal(recordings, options);
  if (admission.training.empty())
    admission.training =
        refusal([&] { admission.coverage = dataset::coverageOf(recordings, options.sections); });
  DiscrepancyProblem measured;
  measured.recordings = std::move(recordings);
  measured.simulation.layout = admission.layout;
  admission.discrepancy = refusal([&] {
    validate(measured);
    admission.faults = findFaults(admit(measured), measured.options, [&](double share) {
                         if (progress) progress("inspecting", kShareOfLooks + (1 - kShareOfLooks) * share);
                       }).faults;
  });
  return admission;
}

}  // namespace fsr::discrepancy
