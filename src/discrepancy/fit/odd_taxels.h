#pragma once

#include <vector>

#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Taxels, rows or columns that deviate from the others, whatever the reason. They are reported when no
/// effect of the library describes a fault.
struct OddTaxels {
  std::vector<std::size_t> taxels;                           ///< row-major indices, ascending; empty = none
  simulation::Covariate by = simulation::Covariate::kTaxel;  ///< or kRow, kColumn
  double share = 0;  ///< share of the readings' squared error that these taxels alone cause
};

/// Tests the residual of every taxel from its static curves, after the mean residual of all taxels has been
/// subtracted. A taxel that hardly responds to the pressure while others do is odd as well.
OddTaxels findOddTaxels(const Measured& measured, const TaxelFit& taxels);

}  // namespace fsr::discrepancy
