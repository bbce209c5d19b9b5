#pragma once

#include <vector>

#include "calibration/stages/memory/history_stream.h"
#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/tables/training_scans.h"
#include "compensation/fit_scheme.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// What a history model is trained on. All must outlive the call.
struct HistoryProblem {
  const std::vector<dataset::Recording>& recordings;
  const dataset::ConditionClasses& classes;
  const std::vector<dataset::Sections>& sections;
  const compensation::SchemePlan& plan;
  const regression::RegressorOptions& regressor;
  const SessionZeros& zeros;  ///< with which the tables were trained
  /// With their rests if the calibration expects a tare at the start of a session: the model then corrects
  /// the answer after the tare. Null = no tare.
  const Sessions* sessions = nullptr;
};

/// Chooses and trains the model of the sheet's memory. Each protocol in turn is predicted by tables and
/// models that were trained without it. `calibration` must have its tables; it receives the model and its
/// scores. Automatically a family is taken only if it is worse than the static answer beyond chance on no
/// protocol, better by 2 % and beyond chance over all of them than the static answer and than c(x) alone, and
/// if there is a memory. Throws InputError if a family is asked for and no protocol can be left out.
void trainHistory(const HistoryProblem& problem, const CalibrationOptions& options, Calibration& calibration);

/// A family, chosen by the errors on protocols that were left out.
struct HistoryVerdict {
  HistoryFamily family = HistoryFamily::kNone;
  HistoryScore score;                         ///< its choice and protocols
  std::vector<Eigen::VectorXd> coefficients;  ///< [protocols] of the family, trained without the protocol
  double rmse = 0;                            ///< of the family on protocols that were left out [Pa]
};

/// The choice of trainHistory(). `names` and `sums` have one entry for each protocol that was left out.
/// Whether there is a memory is asked of the parts of `means`; without them, of those of `sums`.
/// score.protocols is empty if no protocol has a reading that counts.
HistoryVerdict chooseHistory(const HistoryChoice& choice, const HistoryGrid& grid,
                             const std::vector<std::string>& names, const std::vector<LeftOutSums>& sums,
                             const std::vector<LeftOutSums>& means = {});

/// Why no protocol can be left out, and what to record. `protocols`: number of them in the recordings.
std::string whyNoProtocolIsLeftOut(std::size_t protocols);

}  // namespace fsr::calibration
