#pragma once

#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/detections.h"
#include "discrepancy/fit/taxel_fit.h"

namespace fsr::discrepancy {

/// The findings, and the data in which they were found.
struct Found {
  const Measured& measured;
  const CommonTraces& common;
  const StaticFit& fit;
  const TaxelFit& taxels;
  const Decision& decision;
  const std::vector<Detection>& detections;              ///< by detectors and in later rounds
  const std::vector<simulation::EnabledEffect>& beside;  ///< effects found in later rounds
  const Trace& left;      ///< part of the common trace's residual that all findings explain
  bool by_terms = false;  ///< `left` comes from fitted terms, not from effects in a simulation
  /// Mean squared error that static curves of another kind would remove [share of full scale, squared].
  double static_square = 0;
  unsigned threads = 1;
  std::uint64_t seed = 0;
};

/// Writes into `report` where the findings show, and what part of the traces they explain in the hold-out
/// cycles of each surface and each protocol, predicted from a fit to the others. The effects found in
/// `report.added` are confined to the taxels and surfaces where they show. Returns the gap of the fitted
/// traces; the gap that the report states is that of the written simulations (measureDrivenGap()).
Gap reportGap(const Found& found, DiscrepancyReport& report);

}  // namespace fsr::discrepancy
