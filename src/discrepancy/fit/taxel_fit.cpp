#include "discrepancy/fit/taxel_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dataset/count_readers.h"

namespace fsr::discrepancy {

namespace {

constexpr double kRidge = 1e-10;
constexpr double kMostLocal = 8;

}  // namespace

TaxelFit::TaxelFit(const Measured& measured, const StaticFit& fit) : measured_(measured), fit_(fit) {
  const auto size = static_cast<Eigen::Index>(fit.coefficients());
  const auto taxels = static_cast<Eigen::Index>(measured.taxels());
  std::vector<Eigen::MatrixXd> normal(fit.groups(), Eigen::MatrixXd::Zero(size, size));
  coefficients_.assign(fit.groups(), Eigen::MatrixXd::Zero(size, taxels));
  std::vector<double> readings;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.cycles[measured.cycle[i]].use == CycleUse::kHoldOut) continue;
    measured.readings(i, readings);
    const Eigen::Map<const Eigen::RowVectorXd> row(readings.data(), taxels);
    const SplineBasis::Values& at = fit.splines(i);
    for (std::size_t j = 0; j < SplineBasis::kAtOnce; ++j) {
      const auto a = static_cast<Eigen::Index>(at.first + j);
      coefficients_[fit.groupOf(i)].row(a) += at.value[j] * row;
      for (std::size_t k = 0; k < SplineBasis::kAtOnce; ++k) {
        normal[fit.groupOf(i)](a, static_cast<Eigen::Index>(at.first + k)) += at.value[j] * at.value[k];
      }
    }
  }
  for (std::size_t g = 0; g < normal.size(); ++g) {
    normal[g].diagonal().array() += kRidge * normal[g].diagonal().maxCoeff() + 1e-300;
    coefficients_[g] = normal[g].ldlt().solve(coefficients_[g]).eval();
  }
  judgeWithin();
}

void TaxelFit::residuals(std::size_t sample, std::vector<double>& result) const {
  measured_.readings(sample, result);
  const SplineBasis::Values& at = fit_.splines(sample);
  const Eigen::MatrixXd& coefficients = coefficients_[fit_.groupOf(sample)];
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (std::size_t j = 0; j < SplineBasis::kAtOnce; ++j) {
      result[t] -=
          at.value[j] * coefficients(static_cast<Eigen::Index>(at.first + j), static_cast<Eigen::Index>(t));
    }
    if (!measured_.used[t]) result[t] = 0;
  }
}

// The pressure changes within a sample. The common slope is used to subtract the resulting change.
void TaxelFit::judgeWithin() {
  double squares = 0, number = 0;
  std::vector<double> mean;
  std::vector<dataset::ScanCounts> scans(measured_.recordings->begin(), measured_.recordings->end());
  for (std::size_t m = 0; m < measured_.samples(); ++m) {
    if (measured_.scans[m] < 2) continue;
    measured_.recorded(m, mean);
    const Visit& visit = measured_.visits[measured_.visit[m]];
    const dataset::Recording& recording = (*measured_.recordings)[visit.recording];
    const double slope = fit_.slope()[static_cast<Eigen::Index>(m)];
    const double middle = static_cast<double>(measured_.first_scan[m]) + (measured_.scans[m] - 1) / 2.0;
    for (std::size_t s = measured_.first_scan[m]; s < measured_.first_scan[m] + measured_.scans[m]; ++s) {
      const double period =
          recording.time[measured_.first_scan[m] + 1] - recording.time[measured_.first_scan[m]];
      const double moved = slope * measured_.rate[m] * (static_cast<double>(s) - middle) * period;
      const std::uint16_t* counts = scans[visit.recording][s];
      for (std::size_t t = 0; t < mean.size(); ++t) {
        if (!measured_.used[t]) continue;
        squares += std::pow(counts[t] / measured_.full_scale - mean[t] - moved, 2);
        ++number;
      }
    }
  }
  within_ = number > 0 ? squares / number : 0;
}

Spread spreadOf(const Measured& measured, const TaxelFit& taxels, const Trace& trace) {
  const auto rows = static_cast<Eigen::Index>(measured.taxels());
  const auto classes = static_cast<Eigen::Index>(measured.classes.size());
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(rows, classes), square = product;
  Eigen::VectorXd norm = Eigen::VectorXd::Zero(classes), samples = norm;
  std::vector<double> residual;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.cycles[measured.cycle[i]].use == CycleUse::kHoldOut) continue;
    taxels.residuals(i, residual);
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    const double x = trace[static_cast<Eigen::Index>(i)];
    const Eigen::Map<const Eigen::VectorXd> r(residual.data(), rows);
    product.col(c) += x * r;
    square.col(c) += r.cwiseAbs2();
    norm[c] += x * x;
    samples[c] += 1;
  }
  Spread spread;
  spread.amplitude = spread.error =
      Eigen::MatrixXd::Constant(rows, classes, std::numeric_limits<double>::quiet_NaN());
  double sum = 0, squares = 0, number = 0;
  for (Eigen::Index c = 0; c < classes; ++c) {
    for (Eigen::Index t = 0; t < rows; ++t) {
      if (!measured.used[static_cast<std::size_t>(t)] || norm[c] <= 0) continue;
      const double a = product(t, c) / norm[c];
      const double left = std::max(0.0, square(t, c) - a * a * norm[c]);
      spread.amplitude(t, c) = a;
      spread.error(t, c) = std::sqrt(left / std::max(1.0, samples[c] - 1) / norm[c]);
      const double weight = norm[c];  // an amplitude counts by the mean square it causes
      sum += weight * a;
      squares += weight * (a * a - std::pow(spread.error(t, c), 2));
      number += weight;
    }
  }
  const double scans = samples.sum() * static_cast<double>(measured.usedTaxels());
  spread.square = square.sum() / std::max(1.0, scans) + taxels.within();
  if (sum != 0) spread.local = std::clamp(squares * number / (sum * sum), 1.0, kMostLocal);
  return spread;
}

}  // namespace fsr::discrepancy
