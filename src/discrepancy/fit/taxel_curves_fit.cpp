#include "discrepancy/fit/taxel_curves_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "simulation/driven_rig.h"
#include "simulation/effects/enabled_effects.h"
#include "simulation/taxel_curves.h"

namespace fsr::discrepancy {

namespace {

constexpr Eigen::Index kPressures = 24;  // in each curve
constexpr double kSmoothness = 1e-3;     // weight of second differences, relative to one scan per pressure
constexpr double kSameCurvature = 1e-6;  // largest difference of equal curvatures [1/m]

// A scan as measured and as simulated, both [counts].
struct Pair {
  double pressure;   // [Pa]
  double curvature;  // principal, of taxel 0 [1/m]
  bool held_out;     // takes no part in any fit
  const std::uint16_t* measured;
  const double* simulated;
};

// Time spans of the hold-out cycles, since the first scan of the first recording [s].
std::vector<std::pair<double, double>> holdOutTimes(const Measured& measured) {
  std::vector<std::pair<double, double>> times;
  for (const MeasuredCycle& cycle : measured.cycles) {
    if (cycle.use != CycleUse::kHoldOut) continue;
    const bool last = cycle.last >= measured.time.size();
    times.emplace_back(measured.time[cycle.first], last ? INFINITY : measured.time[cycle.last]);
  }
  return times;
}

bool within(const std::vector<std::pair<double, double>>& times, double time) {
  return std::any_of(times.begin(), times.end(),
                     [&](const auto& span) { return time >= span.first && time < span.second; });
}

std::vector<const dataset::Recording*> inOrderOfTime(const Measured& measured) {
  std::vector<const dataset::Recording*> order;
  for (const dataset::Recording& recording : *measured.recordings) order.push_back(&recording);
  std::stable_sort(order.begin(), order.end(), [](const dataset::Recording* a, const dataset::Recording* b) {
    return a->start_ns < b->start_ns;
  });
  return order;
}

// Drives the simulation through everything that was recorded.
void forEachScan(const Measured& measured, const simulation::SimulationSettings& simulation,
                 const std::function<void(const Pair&)>& use) {
  const simulation::SimulationSettings quiet = simulation::withoutNoise(simulation);
  simulation::DrivenRig rig(quiet);
  double end = -INFINITY;
  const std::vector<const dataset::Recording*> order = inOrderOfTime(measured);
  const auto held_out = holdOutTimes(measured);
  const double first = order.front()->time.front();
  for (const dataset::Recording* recording : order) {
    const double start = 1e-9 * static_cast<double>(recording->start_ns - order.front()->start_ns) - first;
    // Bags converted from tables may all begin at the same date. Then each gets a new sheet.
    if (start + recording->time.front() < end) rig = simulation::DrivenRig(quiet);
    end = start + recording->time.back();
    rig.run(*recording, [&](std::size_t scan, const simulation::SensorChain& chain) {
      const matrix::Surface& surface = recording->conditions.at(recording->condition[scan]);
      const double curvature = surface.known() ? matrix::principalCurvature(surface.at({0})) : 0;
      use({recording->pressure[scan], curvature, within(held_out, start + recording->time[scan]),
           recording->scan(scan), chain.reading().data()});
    });
  }
}

// Sums for the fit on one surface, by hats over pressures. The hats lie closer at low pressure, where the law
// bends most.
struct Sums {
  double curvature = 0, low = INFINITY, high = -INFINITY;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kPressures, kPressures);
  Eigen::MatrixXd right;  // [pressures x taxels]

  double at(Eigen::Index k) const {
    const double share = static_cast<double>(k) / (kPressures - 1);
    return low + (high - low) * share * share;
  }
  void add(const Pair& pair, double full_scale) {
    const double share = std::clamp((pair.pressure - low) / (high - low), 0.0, 1.0);
    const auto k = std::min<Eigen::Index>(kPressures - 2,
                                          static_cast<Eigen::Index>(std::sqrt(share) * (kPressures - 1)));
    const double upper = (low + share * (high - low) - at(k)) / (at(k + 1) - at(k)), lower = 1 - upper;
    normal(k, k) += lower * lower;
    normal(k, k + 1) += lower * upper;
    normal(k + 1, k) += lower * upper;
    normal(k + 1, k + 1) += upper * upper;
    for (Eigen::Index t = 0; t < right.cols(); ++t) {
      const double left = (pair.measured[t] - pair.simulated[t]) / full_scale;
      right(k, t) += lower * left;
      right(k + 1, t) += upper * left;
    }
  }
};

Sums& sumsOf(std::vector<Sums>& all, double curvature) {
  const auto same = [&](const Sums& s) { return std::abs(s.curvature - curvature) <= kSameCurvature; };
  const auto found = std::find_if(all.begin(), all.end(), same);
  if (found != all.end()) return *found;
  all.push_back({});
  all.back().curvature = curvature;
  return all.back();
}

simulation::TaxelCurves::OnSurface solved(const Sums& sums) {
  Eigen::MatrixXd normal = sums.normal;
  const double weight = kSmoothness * std::max(1.0, normal.diagonal().mean());
  for (Eigen::Index k = 1; k + 1 < normal.rows(); ++k) {
    const Eigen::Vector3d bend(1, -2, 1);
    normal.block<3, 3>(k - 1, k - 1) += weight * bend * bend.transpose();
  }
  normal.diagonal().array() += 1e-9 * weight;
  const Eigen::MatrixXd added = normal.ldlt().solve(sums.right);
  simulation::TaxelCurves::OnSurface surface{sums.curvature, {}, {}};
  for (Eigen::Index k = 0; k < added.rows(); ++k) {
    surface.pressure.push_back(sums.at(k));
    for (Eigen::Index t = 0; t < added.cols(); ++t) surface.added.push_back(added(k, t));
  }
  return surface;
}

// Returns empty sums for each surface, with its range of pressure over all recordings.
std::vector<Sums> preparedSums(const Measured& measured) {
  std::vector<Sums> all;
  for (const dataset::Recording& recording : *measured.recordings) {
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const matrix::Surface& surface = recording.conditions.at(recording.condition[i]);
      Sums& sums = sumsOf(all, surface.known() ? matrix::principalCurvature(surface.at({0})) : 0);
      sums.low = std::min(sums.low, recording.pressure[i]);
      sums.high = std::max(sums.high, recording.pressure[i]);
    }
  }
  for (Sums& sums : all) {
    sums.high = std::max(sums.high, sums.low + 1);
    sums.right = Eigen::MatrixXd::Zero(kPressures, static_cast<Eigen::Index>(measured.taxels()));
  }
  return all;
}

}  // namespace

simulation::SimulationSettings withTaxelCurves(const Measured& measured,
                                               const simulation::SimulationSettings& simulation,
                                               const std::string& file) {
  simulation::SimulationSettings result = simulation;
  result.taxel_curves.reset();
  std::vector<Sums> all = preparedSums(measured);
  forEachScan(measured, result, [&](const Pair& pair) {
    if (!pair.held_out) sumsOf(all, pair.curvature).add(pair, measured.full_scale);
  });
  simulation::TaxelCurves curves;
  curves.taxels = measured.taxels();
  for (const Sums& sums : all) curves.surfaces.push_back(solved(sums));
  result.taxel_curves = std::make_shared<const simulation::TaxelCurves>(std::move(curves));
  result.taxel_curves_file = file;
  return result;
}

double simulatedGap(const Measured& measured, const simulation::SimulationSettings& simulation) {
  double squares = 0, number = 0;
  forEachScan(measured, simulation, [&](const Pair& pair) {
    if (!pair.held_out) return;
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (!measured.used[t]) continue;
      squares += std::pow((pair.measured[t] - pair.simulated[t]) / measured.full_scale, 2);
      ++number;
    }
  });
  return number > 0 ? std::sqrt(squares / number) : NAN;
}

}  // namespace fsr::discrepancy
