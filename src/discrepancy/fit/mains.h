#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// Hum that runs through the matrix with the scan.
struct Mains {
  bool found = false;
  double share = 0;      ///< of the readings' squared error
  double z = 0;          ///< of its peak among patterns of other pitch
  double amplitude = 0;  ///< [share of full scale]
  double turn = 0;       ///< phase from one taxel of the scan to the next [rad]
  double beat = 0;       ///< what is left of its frequency after sampling [Hz]
  Trace cosine, sine;    ///< its course, for taking it out of the common traces
};

/// A hum has one phase in each taxel, and the phase moves on from taxel to taxel: of all patterns
/// exp(j turn i) in the order of the scan one stands out, and its course turns through all phases. A
/// pattern that stands still in space has one phase only: it is no hum.
Mains findMains(const Measured& measured, const TaxelFit& taxels);

/// Takes its course out of the common traces.
void takeOut(const Mains& mains, const StaticFit& fit, CommonTraces& common);

simulation::EnabledEffect asEffect(const Mains& mains, double full_scale);

}  // namespace fsr::discrepancy
