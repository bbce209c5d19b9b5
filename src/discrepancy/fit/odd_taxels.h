#pragma once

#include <vector>

#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Taxels, rows or columns that go their own way, whatever the reason: what remains to be said of a fault
/// that no effect of the library describes.
struct OddTaxels {
  std::vector<std::size_t> taxels;                           ///< row-major, ascending; empty = none is odd
  simulation::Covariate by = simulation::Covariate::kTaxel;  ///< or kRow, kColumn
  double share = 0;  ///< of the readings' squared error that is theirs alone
};

/// Judges what the static curves leave of every taxel but not of all together. A taxel that hardly answers to
/// the pressure while others do is odd as well.
OddTaxels findOddTaxels(const Measured& measured, const TaxelFit& taxels);

}  // namespace fsr::discrepancy
