#pragma once

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace test_support {

/// A report with a value in every field, for tests of report writers.
fsr::discrepancy::DiscrepancyReport exampleDiscrepancy();

}  // namespace test_support
