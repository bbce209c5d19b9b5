#include "discrepancy/fit/mount_fields.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastZ = 6;

// Smooth functions of the position on the sheet: powers of x and y up to a degree, without the constant.
Eigen::MatrixXd smoothFields(const matrix::Layout& layout, const std::vector<std::size_t>& taxels) {
  const std::size_t degree = taxels.size() >= 40 ? 3 : taxels.size() >= 12 ? 2 : 1;
  const auto n = static_cast<Eigen::Index>(taxels.size());
  Eigen::MatrixXd fields(n, 0);
  const double half_x = std::max(1, layout.size.columns - 1) * layout.pitch_x / 2;
  const double half_y = std::max(1, layout.size.rows - 1) * layout.pitch_y / 2;
  for (std::size_t i = 0; i <= degree; ++i) {
    for (std::size_t j = 0; i + j <= degree; ++j) {
      if (i + j == 0) continue;
      fields.conservativeResize(Eigen::NoChange, fields.cols() + 1);
      for (Eigen::Index t = 0; t < n; ++t) {
        const matrix::Position at = layout.position({taxels[static_cast<std::size_t>(t)]});
        fields(t, fields.cols() - 1) =
            std::pow(at.x / half_x, static_cast<double>(i)) * std::pow(at.y / half_y, static_cast<double>(j));
      }
    }
  }
  fields.rowwise() -= fields.colwise().mean();
  return Eigen::MatrixXd(fields.householderQr().householderQ() * Eigen::MatrixXd::Identity(n, fields.cols()));
}

// Preload and gain of each taxel in one mount, relative to the surface's mean.
struct MountFields {
  Eigen::MatrixXd change;  // [taxels x 2], preload [Pa] and gain
  Eigen::Matrix2d gram;    // Gram matrix of slope and rise, summed over the samples
  double samples = 0;
  std::size_t curvature_class = 0;
};

MountFields fieldsOf(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                     std::size_t visit, const std::vector<std::size_t>& used, const Trace& explained,
                     const Eigen::MatrixXd& mask) {
  MountFields fields;
  const Visit& at = measured.visits[visit];
  fields.curvature_class = at.curvature_class;
  fields.gram.setZero();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(used.size()));
  std::vector<double> residual;
  for (std::size_t i = at.first; i < at.last; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    taxels.residuals(i, residual);
    const Eigen::Vector2d x(fit.slope()[k], fit.netCurve()[k]);
    fields.gram += x * x.transpose();
    for (std::size_t t = 0; t < used.size(); ++t) {
      double r = residual[used[t]];
      if (explained.size() > 0) {
        r -= mask(static_cast<Eigen::Index>(used[t]), static_cast<Eigen::Index>(at.curvature_class)) *
             explained[k];
      }
      right.col(static_cast<Eigen::Index>(t)) += x * r;
    }
    ++fields.samples;
  }
  fields.change = fields.gram.ldlt().solve(right).transpose();
  return fields;
}

}  // namespace

Repositioning findRepositioning(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                                const Trace& explained, const Eigen::MatrixXd& mask) {
  Repositioning found;
  std::vector<std::size_t> used;
  for (std::size_t t = 0; t < measured.taxels(); ++t) {
    if (measured.used[t]) used.push_back(t);
  }
  const std::vector<std::size_t> mounts_of = measured.mounts();
  if (used.size() < 4 || *std::max_element(mounts_of.begin(), mounts_of.end()) < 2) return found;
  const Eigen::MatrixXd smooth = smoothFields(measured.layout, used);
  const auto n = static_cast<double>(used.size()), terms = static_cast<double>(smooth.cols());
  double inside = 0, outside = 0, samples = 0, offsets = 0, gains = 0, mounts = 0;
  std::map<std::size_t, double> by_class;
  for (std::size_t v = 0; v < measured.visits.size(); ++v) {
    if (mounts_of[measured.visits[v].curvature_class] < 2) continue;
    MountFields fields = fieldsOf(measured, fit, taxels, v, used, explained, mask);
    fields.change.rowwise() -= fields.change.colwise().mean().eval();
    const Eigen::MatrixXd smoothed = smooth * (smooth.transpose() * fields.change);
    const double all = (fields.change * fields.gram * fields.change.transpose()).trace();
    const double explains = (smoothed * fields.gram * smoothed.transpose()).trace();
    inside += explains;
    outside += all - explains;
    samples += fields.samples;
    by_class[fields.curvature_class] += explains;
    offsets += smoothed.col(0).squaredNorm() / n;
    gains += smoothed.col(1).squaredNorm() / n;
    ++mounts;
  }
  const double chance = outside / (n - 1 - terms) * terms;  // what the smooth fields would explain by chance
  const Spread nothing = spreadOf(measured, taxels, Trace::Zero(fit.netCurve().size()));
  found.share = nothing.square > 0 ? (inside - chance) / (samples * n) / nothing.square : 0;
  found.z = (inside - chance) / std::max(1e-300, chance * std::sqrt(1 / (terms * mounts)));
  found.offset = std::sqrt(offsets / mounts);
  found.gain = std::sqrt(gains / mounts);
  found.found = found.share >= thresholds::kLeastShareOfError && found.z >= kLeastZ;
  double most = 0;
  for (const auto& [c, square] : by_class) most = std::max(most, square);
  for (const auto& [c, square] : by_class) {
    if (square >= thresholds::kShows * thresholds::kShows * most)
      found.where.conditions.push_back(measured.classes[c].surface);
  }
  if (found.where.conditions.size() == measured.classes.size()) found.where.conditions.clear();
  found.where.pressure = {0, *std::max_element(measured.pressure.begin(), measured.pressure.end())};
  return found;
}

}  // namespace fsr::discrepancy
