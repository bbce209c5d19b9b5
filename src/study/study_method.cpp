#include "fsr_pressure_map/study/study_method.h"

#include <algorithm>

namespace fsr {

namespace {

// Decision on down-sampling: as many scans as one class has, for each model.
std::vector<std::size_t> sharesOf(Scheme scheme, const StudyData& data, BinaryShare binary_share) {
  const auto flats =
      static_cast<std::size_t>(std::count_if(data.classes.begin(), data.classes.end(), isFlat));
  const std::size_t bent = data.classes.size() - flats;
  const std::size_t half =
      scheme == Scheme::kBinaryInput && binary_share == BinaryShare::kHalfAndHalf ? 2 : 1;
  std::vector<std::size_t> one_of;
  for (const CurvatureClass& curvature_class : data.classes) {
    const bool flat = isFlat(curvature_class);
    switch (scheme) {
      case Scheme::kFlatOnly:
        one_of.push_back(flat ? 1 : 0);
        break;
      case Scheme::kPerCurvature:
        one_of.push_back(1);
        break;
      case Scheme::kFlatOrCurved:
      case Scheme::kBinaryInput:
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
  return hasSecondInput(plan.scheme) ? 1 : plan.models.size();
}

std::size_t StudyMethod::modelOf(std::size_t curvature_class) const {
  return models() == 1 ? 0 : plan.model_of_class[curvature_class];
}

std::vector<StudyMethod> paperMethods(const StudyData& data, BinaryShare binary_share) {
  data.flatClass();
  const bool bent = !std::all_of(data.classes.begin(), data.classes.end(), isFlat);
  std::vector<StudyMethod> methods;
  const auto add = [&](Scheme scheme, const std::string& label) {
    methods.push_back(
        {schemeName(scheme), label, planScheme(scheme, data.classes), sharesOf(scheme, data, binary_share)});
  };
  add(Scheme::kFlatOnly, "Flat");
  add(Scheme::kBaseline, "Baseline");
  add(Scheme::kPerCurvature, "Method 1");
  add(Scheme::kCurvatureInput, "Method 2");
  if (bent) {
    add(Scheme::kFlatOrCurved, "Method 3");
    add(Scheme::kBinaryInput, "Method 4");
  }
  add(Scheme::kOneHot, "Method 2, one-hot");
  return methods;
}

std::vector<StudyMethod> furtherMethods(const StudyData& data) {
  std::vector<StudyMethod> methods;
  if (std::all_of(data.classes.begin(), data.classes.end(), isFlat)) return methods;
  const std::vector<std::size_t> all(data.classes.size(), 1);
  const auto add = [&](Scheme scheme, const std::string& label) {
    methods.push_back({schemeName(scheme), label, planScheme(scheme, data.classes), all});
  };
  add(Scheme::kScaledCurvature, "Scaled curvature");
  add(Scheme::kCurvatureMap, "Curvature map");
  add(Scheme::kInterpolated, "Interpolated");
  add(Scheme::kCurvatureRanges, "Curvature ranges");
  return methods;
}

}  // namespace fsr
