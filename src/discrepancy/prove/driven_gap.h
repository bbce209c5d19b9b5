#pragma once

#include <cstdint>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/views.h"

namespace fsr::discrepancy {

/// Measures the gap of two simulations on the hold-out scans by driving both through all recordings, as
/// driveRecordings() does. Fills all fields of Gap that are numbers of this gap.
/// `slope`: of the static curves at each sample [share of full scale / Pa]. `explained`: whether `after` has
/// effects that explain the gap, so that Gap::closed has a meaning. Intervals are of a bootstrap over the
/// hold-out cycles, for two cycles or more.
void measureDrivenGap(const FitView& fit, const HoldOutView& hold_out,
                      const simulation::SimulationSettings& before,
                      const simulation::SimulationSettings& after, const Trace& slope, bool explained,
                      std::uint64_t seed, Gap& gap);

/// The noise that the gap cannot fall below, from the two estimates of it. Both are rms [share of full
/// scale].
double noiseFloor(const Interval& bracket);

}  // namespace fsr::discrepancy
