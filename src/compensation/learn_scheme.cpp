#include "fsr_pressure_map/compensation/learn_scheme.h"

#include "fsr_pressure_map/compensation/curvature_ranges.h"
#include "fsr_pressure_map/compensation/curvature_scale.h"

namespace fsr {

void learnScheme(const TrainingStatistics& statistics, const GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan) {
  if (plan.scheme == Scheme::kScaledCurvature) {
    plan.curvature_scale = learnScale(statistics, grnn, taxels, threads);
  }
  if (plan.scheme == Scheme::kCurvatureRanges) {
    planRanges(learnRanges(statistics, Grnn(grnn), taxels, threads), plan);
  }
}

}  // namespace fsr
