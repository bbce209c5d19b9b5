#pragma once

#include "study/study.h"
#include "study/unit_bootstrap.h"

namespace fsr::study {

/// Summarises a method's held-out errors.
StudyScore scoreOf(const StudyData& data, const StudyMethod& method, const Evaluation& evaluation);

/// Readings and held-out predictions of one taxel, for figures. The two evaluations use all scans and five
/// sections.
TaxelResponse taxelResponse(const StudyData& data, std::size_t taxel_place, const Evaluation& baseline,
                            const Evaluation& per_curvature);

/// Index in StudyData::taxels of the taxel that the figures show.
std::size_t figureTaxel(const StudyData& data, const StudyPlan& plan,
                        const std::vector<double>& rmse_percent);

}  // namespace fsr::study
