#pragma once

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace test_support {

/// A report with something in every field, for tests of those who write it down.
fsr::discrepancy::DiscrepancyReport exampleDiscrepancy();

}  // namespace test_support
