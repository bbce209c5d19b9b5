#pragma once

#include <utility>
#include <vector>

namespace fsr::exports {

/// Scans first .. last of a step.
using Step = std::pair<std::size_t, std::size_t>;

/// Steps in the course of a force [N], which may have NaN. A step begins where the force reaches `threshold`
/// and ends where it has fallen to the middle between it and the lowest force, so noise makes no step. Steps
/// that the beginning or the end of the recording cuts off, and those shorter than 0.1 s, do not count.
/// `time`: of each scan [s].
std::vector<Step> findSteps(const std::vector<double>& force, const std::vector<double>& time,
                            double threshold);

/// A tenth of the range of a force above its lowest, by the quantiles 1 and 99 % [N]; NaN without a force.
double stepThreshold(const std::vector<double>& force);

}  // namespace fsr::exports
