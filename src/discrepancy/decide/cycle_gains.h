#pragma once

#include <cstdint>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/cycle_design.h"

namespace fsr::discrepancy {

/// Probability of what each explanation explains of the gains of the cycles, if nothing were missing,
/// corrected for the search over all of them. 1 where it was not tested.
///
/// Noise with a gain of each cycle takes up an effect that changes from cycle to cycle, so the predictive
/// density under such a noise does not show it. Here the size of that noise is unknown under either
/// hypothesis: the gain of each cycle (the slope of its readings against the static ones) is a constant of
/// its mount plus an autoregressive noise, with or without one signature of a slow effect. Statistic:
/// restricted likelihood ratio, its noise fitted on either side; null: draws of the fitted noise, each fitted
/// again. Source of the likelihood: H. Patterson, R. Thompson, Biometrika 58 (1971) 545-554.
std::vector<double> chanceByGains(const CycleDesign& design, const std::vector<Explaining>& explanations,
                                  std::size_t draws, std::uint64_t seed);

}  // namespace fsr::discrepancy
