#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dataset/reference_errors.h"
#include "discrepancy/samples/faults.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "health/recording_health.h"

namespace fsr::discrepancy {

/// Limits beyond which a recording is reported. All defaults are set here.
struct AdmissionOptions {
  double lag = 0.5;  ///< between matrix and chamber [s]; hysteresis alone causes some tenths
  /// By which the matrix may answer before the chamber [s], at least half the step from scan to scan: the lag
  /// is not known better. No memory of a sheet makes it answer before its load.
  double lead = 0.1;
  double lost_share = 0.001;   ///< share of lost scans that causes a remark (ratio)
  double failing_share = 0.1;  ///< share of dead or stuck taxels beyond which training is not advised (ratio)
  double saturated_share = 0.05;  ///< share of readings at full scale that causes a remark (ratio)
  std::size_t sections = 5;       ///< of the cross-validation for which the coverage is judged
};

/// Properties of one recording.
struct AdmittedRecording {
  std::string name;
  std::size_t scans = 0;
  double seconds = 0;  ///< from its first to its last scan
  std::size_t surfaces = 0;
  bool chamber = false, temperature = false;
  dataset::RecordingLosses losses;
  health::RecordingHealth health;
  std::optional<dataset::ReferenceLag> lag;
};

/// The uses for which the recordings are fit, and the reasons.
struct Admission {
  std::vector<AdmittedRecording> recordings;
  dataset::Coverage coverage;  ///< empty where there is no reference or a curvature is unknown
  matrix::Layout layout;
  std::vector<health::Fault> faults;  ///< spells of failing taxels and lines; empty if the search is not possible
  std::string training;       ///< why `train` would refuse the recordings; empty = it accepts them
  std::string discrepancy;    ///< why `discrepancy` would refuse them; empty = it accepts them
  std::vector<std::string> problems;  ///< why the result of a training would mislead, worst first
  std::vector<std::string> mounts;    ///< that differ from the others of their surface
  std::vector<std::string> remarks;   ///< what else a user should know

  bool fit() const { return training.empty() && problems.empty(); }
};

/// Why recordings are fit for no use, as in Admission::training and Admission::problems. Where nothing is
/// found in such recordings, this does not mean that nothing is missing.
std::vector<std::string> whyNotFit(const std::vector<dataset::Recording>& recordings,
                                   const AdmissionOptions& options = {});

/// Checks recordings before they are used. This is the first step of every use. It never throws because of
/// what the recordings contain. To find out whether `train` and `discrepancy` would refuse the recordings, it
/// calls the validation of each. `progress` is called with what is done and its share.
Admission inspectRecordings(std::vector<dataset::Recording> recordings, const AdmissionOptions& options = {},
                            const DiscrepancyProgress& progress = {});

}  // namespace fsr::discrepancy
