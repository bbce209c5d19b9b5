#include "study/study_method.h"

#include <algorithm>

namespace fsr::study {

namespace {

// The shares for down-sampling: each model uses as many scans as one class has.
std::vector<std::size_t> sharesOf(compensation::Scheme scheme, const StudyData& data,
                                  BinaryShare binary_share) {
  const auto flats =
      static_cast<std::size_t>(std::count_if(data.classes.begin(), data.classes.end(), dataset::isFlat));
  const std::size_t bent = data.classes.size() - flats;
  const std::size_t half =
      scheme == compensation::Scheme::kBinaryInput && binary_share == BinaryShare::kHalfAndHalf ? 2 : 1;
  std::vector<std::size_t> one_of;
  for (const dataset::CurvatureClass& curvature_class : data.classes) {
    const bool flat = dataset::isFlat(curvature_class);
    switch (scheme) {
      case compensation::Scheme::kFlatOnly:
        one_of.push_back(flat ? 1 : 0);
        break;
      case compensation::Scheme::kPerCurvature:
        one_of.push_back(1);
        break;
      case compensation::Scheme::kFlatOrCurved:
      case compensation::Scheme::kBinaryInput:
        one_of.push_back(half * (flat ? flats : bent));
        break;
      default:
        one_of.push_back(data.classes.size());
    }
  }
  return one_of;
}

}  // namespace

std::size_t StudyMethod::models() const {
  return compensation::hasSecondInput(plan.scheme) ? 1 : plan.models.size();
}

std::size_t StudyMethod::modelOf(std::size_t curvature_class) const {
  return models() == 1 ? 0 : plan.model_of_class[curvature_class];
}

std::vector<StudyMethod> paperMethods(const StudyData& data, BinaryShare binary_share) {
  data.flatClass();
  const bool bent = !std::all_of(data.classes.begin(), data.classes.end(), dataset::isFlat);
  std::vector<StudyMethod> methods;
  const auto add = [&](compensation::Scheme scheme, const std::string& label) {
    methods.push_back({compensation::schemeName(scheme), label,
                       compensation::planScheme(scheme, data.classes), sharesOf(scheme, data, binary_share)});
  };
  add(compensation::Scheme::kFlatOnly, "Flat");
  add(compensation::Scheme::kBaseline, "Baseline");
  add(compensation::Scheme::kPerCurvature, "Method 1");
  add(compensation::Scheme::kCurvatureInput, "Method 2");
  if (bent) {
    add(compensation::Scheme::kFlatOrCurved, "Method 3");
    add(compensation::Scheme::kBinaryInput, "Method 4");
  }
  add(compensation::Scheme::kOneHot, "Method 2, one-hot");
  return methods;
}

std::vector<StudyMethod> furtherMethods(const StudyData& data) {
  std::vector<StudyMethod> methods;
  if (std::all_of(data.classes.begin(), data.classes.end(), dataset::isFlat)) return methods;
  const std::vector<std::size_t> all(data.classes.size(), 1);
  const auto add = [&](compensation::Scheme scheme, const std::string& label) {
    methods.push_back(
        {compensation::schemeName(scheme), label, compensation::planScheme(scheme, data.classes), all});
  };
  add(compensation::Scheme::kScaledCurvature, "Scaled curvature");
  add(compensation::Scheme::kCurvatureMap, "Curvature map");
  add(compensation::Scheme::kInterpolated, "Interpolated");
  add(compensation::Scheme::kCurvatureRanges, "Curvature ranges");
  return methods;
}

}  // namespace fsr::study
