#pragma once

#include <vector>

#include "discrepancy/samples/measured.h"
#include "discrepancy/samples/taxel_courses.h"

namespace fsr::discrepancy {

/// A taxel that leaves the others.
struct TaxelFault {
  /// What its readings do in the spells. kOther: they still follow the others, or do neither of the two.
  enum class Kind { kOther, kDead, kStuck };
  std::size_t taxel = 0;
  Kind kind = Kind::kOther;
  double p = 1;                            ///< corrected for all taxels and lengths of spells
  std::vector<std::vector<bool>> failing;  ///< [visits][scans]
};

/// Searches single taxels for spells in which they leave the others. `sound`: for each taxel; others are left
/// out. Returns those that are outliers by `level`.
std::vector<TaxelFault> findTaxelFaults(const Measured& measured, const std::vector<VisitCourses>& courses,
                                        const std::vector<bool>& sound, const DiscrepancyOptions& options);

}  // namespace fsr::discrepancy
