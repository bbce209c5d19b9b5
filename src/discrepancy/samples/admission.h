#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dataset/reference_lag.h"
#include "discrepancy/samples/faults.h"
#include "fsr_pressure_map/dataset/coverage.h"
#include "health/recording_health.h"

namespace fsr::discrepancy {

/// What may be wrong with recordings before somebody should look at it; every default stands here.
struct AdmissionOptions {
  double lag = 0.5;           ///< between matrix and chamber [s]; hysteresis alone looks like some tenths
  double lost_share = 0.001;  ///< of the scans, before it is remarked (ratio)
  double failing_share =
      0.1;  ///< of the taxels that are dead or stuck, before training is not advised (ratio)
  double saturated_share = 0.05;  ///< of the readings, before it is remarked (ratio)
  std::size_t sections = 5;       ///< of the cross-validation that coverage is judged for
};

/// One recording as it stands.
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

/// Which use the recordings are fit for, and why.
struct Admission {
  std::vector<AdmittedRecording> recordings;
  dataset::Coverage coverage;  ///< empty where there is no reference or a curvature is unknown
  matrix::Layout layout;
  std::vector<Fault> faults;  ///< spells of failing taxels and lines; empty where they cannot be looked for
  std::string training;       ///< why `train` would refuse; empty = it would not
  std::string discrepancy;    ///< why `discrepancy` would refuse; empty = it would not
  std::vector<std::string> problems;  ///< why what comes of training would mislead, worst first
  std::vector<std::string> remarks;   ///< what else a user should know

  bool fit() const { return training.empty() && problems.empty(); }
};

/// Looks at recordings before anybody blames an algorithm: step 0 of every use. Never throws for what they
/// hold; what `train` and `discrepancy` would say is asked of their own rules.
Admission inspectRecordings(std::vector<dataset::Recording> recordings, const AdmissionOptions& options = {});

}  // namespace fsr::discrepancy
