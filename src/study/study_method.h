#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compensation/scheme_plan.h"
#include "study/study_data.h"

namespace fsr::study {

/// One column of the paper's tables: a scheme, and which part of the data it takes.
struct StudyMethod {
  std::string id;     ///< the scheme's name, e.g. per_curvature
  std::string label;  ///< the paper's, e.g. "Method 1"
  compensation::SchemePlan plan;
  std::vector<std::size_t> one_of;  ///< of each class one scan of so many; 0 = none

  /// Models whose scores are averaged; with a second input there is one.
  std::size_t models() const;
  /// The one of them that trains on the class; models() where none does.
  std::size_t modelOf(std::size_t curvature_class) const;
  /// Classes that it trains on.
  const std::vector<std::size_t>& trainedOn(std::size_t model) const { return plan.models[model].trained_on; }
};

/// The paper's seven, in the order of its tables: flat, baseline, methods 1 to 4, method 2 with a one-hot
/// input. Methods 3 and 4 need a bent class beside the flat one; without one they are left out. Throws
/// InputError where there is no flat class.
std::vector<StudyMethod> paperMethods(const StudyData& data, BinaryShare binary_share);

/// Schemes beyond the paper, on all scans: curvature with a length scale of its own, a learned monotone law
/// of curvature, interpolation between curvatures, ranges of curvature chosen from data. None where nothing
/// is bent.
std::vector<StudyMethod> furtherMethods(const StudyData& data);

}  // namespace fsr::study
