#include "compensation/learn_scheme.h"

#include "compensation/curvature_ranges.h"
#include "compensation/curvature_scale.h"

namespace fsr::compensation {

void learnScheme(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan) {
  if (plan.scheme == Scheme::kScaledCurvature) {
    plan.curvature_scale = learnScale(statistics, grnn, taxels, threads);
  }
  if (plan.scheme == Scheme::kCurvatureRanges) {
    planRanges(learnRanges(statistics, regression::Grnn(grnn), taxels, threads), plan);
  }
}

}  // namespace fsr::compensation
