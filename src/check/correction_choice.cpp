#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "check/correction.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/paired_tests.h"

namespace fsr::check {

namespace {

constexpr ChangeModel kModels[kChangeModels] = {ChangeModel::kNone, ChangeModel::kSheet,
                                                ChangeModel::kTaxels};

using Cycles = CorrectionFit::Cycles;
using Held = std::array<std::vector<CheckedReadings>, kChangeModels>;  // of each cycle that was left out

CheckedReadings total(const std::vector<CheckedReadings>& errors) {
  CheckedReadings sum;
  for (const CheckedReadings& one : errors) sum.add(one);
  return sum;
}

Held leaveEachOut(const CorrectionFit& fit, const Cycles& cycles) {
  Held held;
  for (std::size_t out = 0; out < cycles.size(); ++out) {
    if (!cycles[out]) continue;
    Cycles rest = cycles;
    rest[out] = false;
    for (std::size_t m = 0; m < kChangeModels; ++m)
      held[m].push_back(fit.errors(fit.fit(kModels[m], rest), out));
  }
  return held;
}

std::size_t best(const Held& held, ChangeModel richest) {
  std::size_t best = 0;
  for (std::size_t m = 1; m <= static_cast<std::size_t>(richest); ++m) {
    if (total(held[m]).square < total(held[best]).square) best = m;
  }
  return best;
}

double oneSidedP(const std::vector<CheckedReadings>& none, const std::vector<CheckedReadings>& choice) {
  std::vector<double> before, after;
  for (std::size_t i = 0; i < none.size(); ++i) {
    if (none[i].readings == 0 || !(none[i].square > 0) || !(choice[i].square > 0)) continue;
    before.push_back(2 * std::log(none[i].rmse()));
    after.push_back(2 * std::log(choice[i].rmse()));
  }
  if (before.size() < 3) return 1;
  try {
    const statistics::PairedT test = statistics::pairedT(before, after);
    return test.mean_difference > 0 ? test.test.p / 2 : 1 - test.test.p / 2;
  } catch (const settings::InputError&) {
    return before.front() > after.front() ? 0 : 1;  // all cycles gain or lose exactly the same
  }
}

}  // namespace

CorrectionChoice chooseCorrection(const CorrectionFit& fit, ChangeModel richest) {
  const Cycles all(fit.readings().cycles(), true);
  const Held held = leaveEachOut(fit, all);
  CorrectionChoice choice;
  for (std::size_t m = 0; m < kChangeModels; ++m) choice.rmse[m] = total(held[m]).rmse();
  choice.expected = total(held[0]).expectedRmse();
  choice.model = kModels[best(held, richest)];
  choice.changes = fit.fit(choice.model, all);
  std::vector<CheckedReadings> nested;
  for (std::size_t out = 0; out < all.size(); ++out) {
    Cycles rest = all;
    rest[out] = false;
    nested.push_back(held[best(leaveEachOut(fit, rest), richest)][out]);
  }
  choice.nested = total(nested).rmse();
  choice.p = oneSidedP(held[0], nested);
  return choice;
}

// ---- what mounts alone do --------------------------------------------------------------------------

namespace {

double square(double value) {
  return value * value;
}

double probability(double size, double error, std::size_t freedom) {
  if (size == 0) return 1;
  if (error == 0) return 0;
  return 2 * boost::math::cdf(boost::math::students_t(double(freedom)), -size / error);
}

Eigen::Map<const Eigen::VectorXd> changeOf(const MountChange& mount) {
  return {mount.change.data(), static_cast<Eigen::Index>(mount.change.size())};
}

// The cycles of each mount, by surface and number.
using MountCycles = std::map<std::pair<std::size_t, std::uint32_t>, CorrectionFit::Cycles>;

MountCycles mountsOf(const CycleReadings& readings) {
  MountCycles mounts;
  for (std::size_t cycle = 0; cycle < readings.cycles(); ++cycle) {
    const CycleReadings::Stay& stay = readings.stayOf(cycle);
    mounts.try_emplace({stay.surface, stay.mount}, readings.cycles(), false).first->second[cycle] = true;
  }
  return mounts;
}

// [surfaces] of the recheck: number of mounts in the training, 1 where it is not known.
std::vector<std::size_t> trainedMounts(const calibration::Calibration& parent,
                                       const std::vector<std::string>& surfaces) {
  std::vector<std::size_t> mounts(surfaces.size(), 1);
  for (std::size_t s = 0; s < parent.shape.surfaces.size(); ++s) {
    const auto found = std::find(surfaces.begin(), surfaces.end(), parent.shape.surfaces[s]);
    if (found != surfaces.end()) mounts[std::size_t(found - surfaces.begin())] = parent.shape.mounts[s];
  }
  return mounts;
}

}  // namespace

CommonChange testCommonChange(const std::vector<MountChange>& mounts,
                              const std::vector<std::size_t>& trained_mounts, const MountScatter& trained) {
  CommonChange result;
  if (mounts.empty()) return result;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(changeOf(mounts.front()).size());
  std::vector<Eigen::VectorXd> mean(trained_mounts.size(), zero);  // of each surface
  std::vector<double> number(mean.size(), 0.0), weight(mean.size(), 0.0);
  for (const MountChange& mount : mounts) {
    mean[mount.surface] += changeOf(mount);
    number[mount.surface] += 1;
  }
  Eigen::VectorXd common = zero;
  double weights = 0, squares = 0;
  for (std::size_t s = 0; s < mean.size(); ++s) {
    if (number[s] == 0) continue;
    mean[s] /= number[s];
    weight[s] = 1 / (1 / number[s] + 1 / double(trained_mounts[s]));  // inverse variance, sigma = 1
    weights += weight[s];
    common += weight[s] * mean[s];
  }
  common /= weights;
  for (std::size_t s = 0; s < mean.size(); ++s) squares += weight[s] * (mean[s] - common).squaredNorm();
  for (const MountChange& mount : mounts) squares += (changeOf(mount) - mean[mount.surface]).squaredNorm();
  result.size = common.norm();
  const std::size_t freedom = mounts.size() - 1;
  result.scatter = trained;
  if (freedom > trained.freedom) result.scatter = {std::sqrt(squares / double(freedom)), freedom};
  if (result.scatter.known())
    result.p =
        probability(result.size, result.scatter.deviation / std::sqrt(weights), result.scatter.freedom);
  return result;
}

MountTest testMounts(const calibration::Calibration& parent, const CorrectionFit& fit) {
  std::vector<MountChange> sheet, taxels;
  const MountCycles mounts = mountsOf(fit.readings());
  for (const auto& [mount, cycles] : mounts) {
    sheet.push_back({mount.first, fit.sheetEffect(cycles)});
    taxels.push_back({mount.first, fit.taxelEffects(cycles)});
  }
  MountTest test;
  test.mounts = mounts.size();
  const std::vector<std::size_t> trained = trainedMounts(parent, fit.readings().surfaces);
  const MountScatter scatter = trainedScatter(parent);
  test.sheet = testCommonChange(sheet, trained, scatter);
  test.taxels = testCommonChange(taxels, trained, scatter);
  return test;
}

double errorWithinMounts(const CorrectionFit& fit) {
  CheckedReadings sum;
  for (const auto& [mount, cycles] : mountsOf(fit.readings())) {
    if (std::count(cycles.begin(), cycles.end(), true) < 2) continue;
    for (std::size_t out = 0; out < cycles.size(); ++out) {
      if (!cycles[out]) continue;
      CorrectionFit::Cycles rest = cycles;
      rest[out] = false;
      sum.add(fit.errors(fit.fit(ChangeModel::kTaxels, rest), out));
    }
  }
  return sum.readings == 0 ? std::numeric_limits<double>::infinity() : sum.rmse();
}

// The error of a left-out mount has the variance of m / (m - 1) mounts, and that of a left-out section
// already contains that of (m - 1) / m. Where the number of mounts is not in the file, their difference is
// taken for that of two mounts, with one degree of freedom.
MountScatter trainedScatter(const calibration::Calibration& parent) {
  const calibration::RemountScore& remount = parent.scores.remount;
  if (remount.readings == 0) return {};
  const double within = parent.scores.whole.errors.whole.all.rmse;
  const calibration::ErrorIntervals& intervals = parent.budget.intervals;
  const bool counted = intervals.present() && intervals.unit == calibration::IntervalUnit::kMounts;
  const double mounts = counted ? double(intervals.whole.units) : 2;
  // Surfaces that were mounted once are none of them, and each of the others was mounted twice at least.
  const double surfaces =
      std::max(1.0, std::min(double(parent.coverage.conditions.size()), std::floor(mounts / 2)));
  const double m = std::max(2.0, mounts / surfaces);
  const double share = m / (m - 1) - (m - 1) / m;
  return {std::sqrt(std::max(0.0, square(remount.rmse) - square(within)) / share),
          std::size_t(std::max(1.0, mounts - surfaces))};
}

}  // namespace fsr::check
