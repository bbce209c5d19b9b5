#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compensation/scheme_plan.h"
#include "study/study_data.h"

namespace fsr::study {

/// One column of the paper's tables: a scheme, and the share of the data that it uses.
struct StudyMethod {
  std::string id;     ///< name of the scheme, e.g. per_curvature
  std::string label;  ///< name in the paper, e.g. "Method 1"
  compensation::SchemePlan plan;
  std::vector<std::size_t> one_of;  ///< [classes]: the method uses one of so many scans; 0 = none

  /// Number of models whose scores are averaged. A scheme with a second input has one model.
  std::size_t models() const;
  /// The model that is trained on the class; models() if there is none.
  std::size_t modelOf(std::size_t curvature_class) const;
  /// Classes that the model is trained on.
  const std::vector<std::size_t>& trainedOn(std::size_t model) const { return plan.models[model].trained_on; }
};

/// The paper's seven methods, in the order of its tables: flat, baseline, methods 1 to 4, and method 2 with a
/// one-hot input. Methods 3 and 4 are left out if there is no bent class. Throws InputError if there is no
/// flat class.
std::vector<StudyMethod> paperMethods(const StudyData& data, BinaryShare binary_share);

/// Schemes beyond the paper, on all scans: curvature with a length scale of its own, a learned monotone law
/// of curvature, interpolation between curvatures, and ranges of curvature chosen from data. Empty if there
/// is no bent class.
std::vector<StudyMethod> furtherMethods(const StudyData& data);

}  // namespace fsr::study
