#pragma once

#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/detections.h"

namespace fsr::discrepancy {

/// What was found, and what it was found in.
struct Found {
  const Measured& measured;
  const CommonTraces& common;
  const StaticFit& fit;
  const TaxelFit& taxels;
  const Candidates& candidates;
  const Decision& decision;
  const std::vector<Detection>& detections;              ///< of detectors, and of later rounds
  const std::vector<simulation::EnabledEffect>& beside;  ///< effects of later rounds
  const Trace& left;      ///< what all this takes from the common trace's residual
  bool by_terms = false;  ///< `left` is that of fitted terms, not of effects in a simulation
  /// Error that static curves of another kind would take away [share of full scale, squared].
  double static_square = 0;
  unsigned threads = 1;
  std::uint64_t seed = 0;
};

/// Shows in `report` where it acts and how far it closes the gap: on cycles that took no part in anything, on
/// each surface and each protocol foretold by what was fitted to the others; confines the effects of
/// `report.added` to where they act.
void reportGap(const Found& found, DiscrepancyReport& report);

}  // namespace fsr::discrepancy
