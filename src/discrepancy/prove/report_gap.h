#pragma once

#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/detections.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

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

/// Computes the pressure errors that effects cause in use. The effects are those in `with` but not in
/// `without`. The sheet is read through static curves that were fitted to these recordings. The result holds
/// the largest error in each of three situations: a ramp over the recorded range, the last of several steps
/// of 0.6 s, and ten minutes of standing. Steps and standing reach half the highest pressure. The worst
/// surface counts; on each, the situations reach up to the highest pressure that was recorded there.
/// Pressures below a tenth of the situation's peak do not count, nor those where the static curve is so flat
/// that its reading tells nothing (a slope below a twentieth of the usual one), nor readings beyond the ends
/// of the curve. `closed`: share of the squared error that a model with these effects removes. The error that
/// remains is the cost after.
std::vector<GapInUse> costsInUse(const Measured& measured, const simulation::SimulationSettings& without,
                                 const simulation::SimulationSettings& with, double closed);

}  // namespace fsr::discrepancy
