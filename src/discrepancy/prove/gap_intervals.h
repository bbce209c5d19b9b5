#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Sets the 95 % intervals of `gap` by a bootstrap over its cycles. `of(chosen)` returns the gap of the
/// chosen cycles, indices below `cycles` that may repeat. Without a cycle the intervals are NaN.
void setIntervals(std::size_t cycles, std::uint64_t seed,
                  const std::function<Gap(const std::vector<std::size_t>& chosen)>& of, Gap& gap);

}  // namespace fsr::discrepancy
