#pragma once

#include <vector>

#include "discrepancy/samples/measured.h"
#include "discrepancy/samples/taxel_courses.h"

namespace fsr::discrepancy {

/// A row or column that fails in spells.
struct LineFault {
  bool found = false;
  std::size_t line = 0;
  std::vector<std::size_t> taxels;         ///< row-major
  double p = 1;                            ///< corrected for all lines
  std::vector<std::vector<bool>> failing;  ///< [visits][scans]
};

/// Searches rows (or columns) for steps from one scan to the next in which their taxels leave the
/// neighbouring lines together. `sound`: for each taxel; others are left out.
LineFault findLineFault(const Measured& measured, const std::vector<VisitCourses>& courses, bool rows,
                        const std::vector<bool>& sound, const DiscrepancyOptions& options);

}  // namespace fsr::discrepancy
