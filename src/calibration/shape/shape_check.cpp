#include "calibration/shape/shape_check.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "compensation/shape/read_shape.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr double kWidest = 0.5;   // share of the range of training: a wider interval tells too little
constexpr double kBadFit = 1e-3;  // a fit that is worse with this probability says that something else acts

std::string declaredText(const matrix::Surface& surface) {
  const std::string name = surface.name.empty() ? "the declared surface" : surface.name;
  return name + " (" + bendText(matrix::principalCurvature(surface.curvature.front())) + ")";
}

std::string abstention(const std::string& why) {
  return "how the sheet lies cannot be told: " + why;
}

std::string unfit(const compensation::ShapeModel& model) {
  return "the readings at rest fit none of the bends of training, " + bendText(model.curvature.front()) +
         " to " + bendText(model.curvature.back()) +
         "; a load or a strap, another temperature, another sheet or a bend beyond training would explain it";
}

}  // namespace

std::string bendText(double curvature) {
  if (std::abs(curvature) <= dataset::kFlatCurvature) return "flat";
  return (curvature < 0 ? "concave, " : "") + settings::fixedText(100 / std::abs(curvature), 1) + " cm";
}

std::string restText(const compensation::ShapeEstimate& estimate) {
  return "the sheet rests as on " + bendText(estimate.curvature) + " (" + bendText(estimate.high) + " to " +
         bendText(estimate.low) + ")";
}

std::string openText(const compensation::ShapeEstimate& estimate) {
  return abstention("the readings at rest leave " + bendText(estimate.high) + " to " +
                    bendText(estimate.low) + " open");
}

namespace {

std::vector<double> principalCurvatures(const matrix::Surface& surface) {
  std::vector<double> curvatures;
  for (const matrix::Curvature& c : surface.curvature) curvatures.push_back(matrix::principalCurvature(c));
  return curvatures;
}

// Judges an estimate that fits.
void judge(const compensation::ShapeModel& model, const matrix::Surface& declared, bool agrees,
           ShapeCheck& check) {
  const compensation::ShapeEstimate& estimate = check.estimate;
  const std::string found = restText(estimate);
  const double range = model.curvature.back() - model.curvature.front();
  check.estimated = !estimate.beyond && estimate.high - estimate.low <= kWidest * range;
  if (!declared.known()) {
    check.sentence = check.estimated ? found + "; no surface is declared" : openText(estimate);
  } else if (agrees) {
    check.verdict = ShapeVerdict::kAgrees;
    check.sentence = found + ", which agrees with " + declaredText(declared);
  } else if (estimate.beyond) {
    check.sentence = abstention(unfit(model));
  } else {
    check.verdict = ShapeVerdict::kDisagrees;
    check.sentence = found + ", but the surface file says " + declaredText(declared);
  }
}

}  // namespace

ShapeCheck checkShape(const compensation::ShapeModel& model, const compensation::RestReading& rest,
                      const matrix::Surface& declared, double alarm) {
  ShapeCheck check;
  check.sentence = abstention(model.missing);
  if (!model.present()) return check;
  const double limit = boost::math::quantile(boost::math::complement(boost::math::chi_squared(1), alarm));
  try {
    const compensation::ShapeReader reader(model);
    check.estimate = reader.estimate(rest);
    const auto agrees = [&](const std::vector<double>& curvature) {
      return 2 * (check.estimate.likelihood - reader.likelihood(rest, curvature)) <= limit;
    };
    check.sentence = abstention(unfit(model));
    if (check.estimate.fit < kBadFit) return check;
    for (std::size_t s = 0; s < model.curvature.size(); ++s) {
      if (agrees({model.curvature[s]})) check.possible.push_back(model.surfaces[s]);
    }
    judge(model, declared, declared.known() && agrees(principalCurvatures(declared)), check);
  } catch (const settings::InputError& error) {
    check.sentence = abstention(error.what());
  }
  return check;
}

}  // namespace fsr::calibration
