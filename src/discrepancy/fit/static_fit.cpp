#include "discrepancy/fit/static_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "statistics/samples.h"

namespace fsr::discrepancy {

SplineBasis::SplineBasis(const std::vector<double>& knots) {
  knots_.assign(kAtOnce - 1, knots.front());
  knots_.insert(knots_.end(), knots.begin(), knots.end());
  knots_.insert(knots_.end(), kAtOnce - 1, knots.back());
}

std::size_t SplineBasis::piece(double x) const {
  const auto last = knots_.end() - static_cast<std::ptrdiff_t>(kAtOnce);
  const auto after = std::upper_bound(knots_.begin() + kAtOnce, last, x);
  return static_cast<std::size_t>(after - knots_.begin()) - 1;
}

SplineBasis::Values SplineBasis::at(double x) const {
  x = std::clamp(x, knots_.front(), knots_.back());
  const std::size_t k = piece(x);
  Values values;
  values.first = k - (kAtOnce - 1);
  std::array<double, kAtOnce> lower{1, 0, 0, 0}, next{};
  // Cox and de Boor's recursion, degree by degree. The last but one degree gives the slopes.
  for (std::size_t degree = 1; degree < kAtOnce; ++degree) {
    next.fill(0);
    if (degree == kAtOnce - 1) values.slope.fill(0);
    for (std::size_t j = 0; j < degree; ++j) {
      const double left = knots_[k + j + 1 - degree], right = knots_[k + j + 1];
      const double share = lower[j] / (right - left);
      next[j] += (right - x) * share;
      next[j + 1] += (x - left) * share;
      if (degree == kAtOnce - 1) {
        values.slope[j] -= static_cast<double>(degree) * share;
        values.slope[j + 1] += static_cast<double>(degree) * share;
      }
    }
    lower = next;
  }
  values.value = lower;
  return values;
}

namespace {

// Shares of the range. Knots lie closer at low pressure, where static curves bend most.
constexpr double kKnots[] = {0, 0.012, 0.03, 0.06, 0.1, 0.15, 0.22, 0.3, 0.4, 0.52, 0.64, 0.76, 0.88, 1};
// Weight of the squared second differences, relative to the largest diagonal element. It is too small to
// bend what scans determine; coefficients that no scan determines continue the curve as a straight line.
constexpr double kBends = 1e-8;
// Least scatter of the cycle gains; smaller scatter does not matter [relative].
constexpr double kLeastScatter = 1e-5;

std::vector<double> knotsOf(const Trace& load) {
  const double low = load.minCoeff(), high = std::max(load.maxCoeff(), low + 1);
  std::vector<double> knots;
  for (const double share : kKnots) knots.push_back(low + share * (high - low));
  return knots;
}

Trace loadOf(const Measured& measured) {
  return Eigen::Map<const Trace>(measured.loads().data(), static_cast<Eigen::Index>(measured.samples()));
}

template <typename Use>
void eachSpline(const SplineBasis::Values& at, Use use) {
  for (std::size_t j = 0; j < SplineBasis::kAtOnce; ++j) {
    use(static_cast<Eigen::Index>(at.first + j), at.value[j], at.slope[j]);
  }
}

// Squares of the second differences of a spline's coefficients. They vanish for a straight line.
Eigen::MatrixXd bendsOf(const SplineBasis& basis) {
  const auto size = static_cast<Eigen::Index>(basis.size());
  Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(size - 2, size);
  for (Eigen::Index k = 1; k + 1 < size; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double before = basis.middle(at) - basis.middle(at - 1),
                 after = basis.middle(at + 1) - basis.middle(at), mean = (before + after) / 2;
    differences(k - 1, k - 1) = mean / before;
    differences(k - 1, k) = -mean / before - mean / after;
    differences(k - 1, k + 1) = mean / after;
  }
  return differences.transpose() * differences;
}

Eigen::LDLT<Eigen::MatrixXd> decompose(Eigen::MatrixXd matrix, const Eigen::MatrixXd& bends) {
  const double most = matrix.diagonal().maxCoeff();
  matrix += kBends * most * bends;
  matrix.diagonal().array() += std::numeric_limits<double>::epsilon() * most + 1e-300;
  return matrix.ldlt();
}

// Samples to which the curves are fitted: those of the fit cycles, and all of a group that has none.
std::vector<bool> fittedSamples(const Measured& measured, const std::vector<std::uint32_t>& group,
                                std::size_t groups) {
  std::vector<bool> has(groups, false), fitted;
  const auto of_fit = [&](std::size_t i) { return measured.cycles[measured.cycle[i]].use == CycleUse::kFit; };
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (of_fit(i)) has[group[i]] = true;
  }
  for (std::size_t i = 0; i < group.size(); ++i) fitted.push_back(of_fit(i) || !has[group[i]]);
  return fitted;
}

}  // namespace

CommonTraces commonTraces(const Measured& measured) {
  CommonTraces traces;
  traces.all.setZero(static_cast<Eigen::Index>(measured.samples()));
  std::vector<double> readings;
  for (std::size_t scan = 0; scan < measured.samples(); ++scan) {
    measured.readings(scan, readings);
    double sum = 0;
    for (std::size_t i = 0; i < readings.size(); ++i) sum += measured.used[i] ? readings[i] : 0;
    traces.all[static_cast<Eigen::Index>(scan)] = sum / static_cast<double>(measured.usedTaxels());
  }
  return traces;
}

StaticFit::StaticFit(const Measured& measured, CurvePer per, const Trace& common) : measured_(measured) {
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    group_.push_back(per == CurvePer::kVisit ? measured.visit[i]
                                             : static_cast<std::uint32_t>(measured.classOf(i)));
  }
  per_ = per;
  groups_ = per == CurvePer::kVisit ? measured.visits.size() : measured.classes.size();
  fits_ = fittedSamples(measured, group_, groups_);
  fitCurves(common, loadOf(measured));
  judgeGainScatter(residual(common));
}

StaticFit::StaticFit(const StaticFit& like, const Trace& common, const Trace& load)
    : measured_(like.measured_),
      group_(like.group_),
      fits_(like.fits_),
      groups_(like.groups_),
      per_(like.per_),
      gain_weight_(like.gain_weight_) {
  fitCurves(common, load);
  prepare();
}

void StaticFit::fitCurves(const Trace& common, const Trace& load) {
  basis_ = SplineBasis(knotsOf(load));
  for (Eigen::Index i = 0; i < load.size(); ++i) splines_.push_back(basis_.at(load[i]));
  for (const Eigen::MatrixXd& matrix : normalMatrices()) plain_.push_back(decompose(matrix, bendsOf(basis_)));
  fitted_ = coefficientsOf(common, plain_);
  curve_ = curveFrom(fitted_);
  slope_.resize(common.size());
  for (Eigen::Index i = 0; i < common.size(); ++i) {
    double slope = 0;
    const auto scan = static_cast<std::size_t>(i);
    eachSpline(splines_[scan],
               [&](Eigen::Index k, double, double s) { slope += s * fitted_(k, group_[scan]); });
    slope_[i] = std::max(slope, 0.0);
  }
  zero_ = INFINITY;
  reach_.assign(groups_, {INFINITY, -INFINITY});
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    if (!fits_[i]) continue;
    const auto at = static_cast<Eigen::Index>(i);
    zero_ = std::min(zero_, curve_[at]);
    settings::Range& reach = reach_[group_[i]];
    reach.low = std::min(reach.low, load[at]);
    reach.high = std::max(reach.high, load[at]);
  }
  net_curve_ = curve_.array() - zero_;
}

std::vector<Eigen::MatrixXd> StaticFit::normalMatrices() const {
  const auto size = static_cast<Eigen::Index>(basis_.size());
  std::vector<Eigen::MatrixXd> normal(groups_, Eigen::MatrixXd::Zero(size, size));
  for (std::size_t i = 0; i < splines_.size(); ++i) {
    if (!fits_[i]) continue;
    eachSpline(splines_[i], [&](Eigen::Index a, double x, double) {
      eachSpline(splines_[i], [&](Eigen::Index b, double y, double) { normal[group_[i]](a, b) += x * y; });
    });
  }
  return normal;
}

double StaticFit::curveAt(std::size_t scan, double load) const {
  const settings::Range& fitted = reach_[group_[scan]];
  const double within = std::clamp(load, fitted.low, fitted.high);
  double value = 0, slope = 0;
  eachSpline(basis_.at(within), [&](Eigen::Index k, double x, double s) {
    value += x * fitted_(k, group_[scan]);
    slope += s * fitted_(k, group_[scan]);
  });
  return std::max(value + std::max(slope, 0.0) * (load - within), std::min(zero_, value));
}

Eigen::MatrixXd StaticFit::coefficientsOf(const Trace& trace, const std::vector<Normal>& normal) const {
  Eigen::MatrixXd right =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(basis_.size()), static_cast<Eigen::Index>(groups_));
  for (std::size_t i = 0; i < splines_.size(); ++i) {
    if (!fits_[i]) continue;
    const double y = trace[static_cast<Eigen::Index>(i)];
    eachSpline(splines_[i], [&](Eigen::Index k, double x, double) { right(k, group_[i]) += x * y; });
  }
  for (std::size_t g = 0; g < groups_; ++g) {
    const auto column = static_cast<Eigen::Index>(g);
    right.col(column) = normal[g].solve(right.col(column)).eval();
  }
  return right;
}

Trace StaticFit::curveFrom(const Eigen::MatrixXd& coefficients) const {
  Trace curve(static_cast<Eigen::Index>(splines_.size()));
  for (std::size_t i = 0; i < splines_.size(); ++i) {
    double value = 0;
    eachSpline(splines_[i],
               [&](Eigen::Index k, double x, double) { value += x * coefficients(k, group_[i]); });
    curve[static_cast<Eigen::Index>(i)] = value;
  }
  return curve;
}

Trace StaticFit::residual(const Trace& trace) const {
  return trace - curveFrom(coefficientsOf(trace, plain_));
}

// Multiplies each cycle's component along its gain by the cycle's weight.
void StaticFit::applyGainWeights(Trace& trace) const {
  for (std::size_t c = 0; c < measured_.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured_.cycles[c];
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto scans = static_cast<Eigen::Index>(cycle.last - cycle.first);
    const auto gain = net_curve_.segment(first, scans);
    const double square = gain.squaredNorm();
    if (square <= 0) continue;
    trace.segment(first, scans) +=
        (gain_weight_[c] - 1) * gain.dot(trace.segment(first, scans)) / square * gain;
  }
}

// The curves are shrunk in the same way: x' = W x, B' = W B, and B'^T x' = B^T W (W x).
Trace StaticFit::project(const Trace& trace) const {
  Trace weighted = trace;
  applyGainWeights(weighted);
  Trace twice = weighted;
  applyGainWeights(twice);
  Trace curve = curveFrom(coefficientsOf(twice, weighted_));
  applyGainWeights(curve);
  return weighted - curve;
}

void StaticFit::judgeGainScatter(const Trace& left) {
  std::vector<double> gain, weight;
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto scans = static_cast<Eigen::Index>(cycle.last - cycle.first);
    weight.push_back(net_curve_.segment(first, scans).squaredNorm());
    gain.push_back(weight.back() > 0
                       ? net_curve_.segment(first, scans).dot(left.segment(first, scans)) / weight.back()
                       : 0);
  }
  std::vector<double> steps;
  std::optional<std::size_t> before;
  for (std::size_t c = 0; c < gain.size(); ++c) {
    if (!fits_[measured_.cycles[c].first]) continue;
    if (before && measured_.cycles[c].visit == measured_.cycles[*before].visit)
      steps.push_back(std::abs(gain[c] - gain[*before]));
    before = c;
  }
  gain_weight_.resize(gain.size());
  const double scatter = std::max(
      kLeastScatter, statistics::kDeviationPerMedian / std::sqrt(2.0) * statistics::upperMedian(steps, 0));
  double square = 0, samples = 0;
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    if (!fits_[i]) continue;
    square += std::pow(left[static_cast<Eigen::Index>(i)], 2);
    ++samples;
  }
  const double noise = square / std::max(1.0, samples);
  for (std::size_t c = 0; c < gain.size(); ++c) {
    const double by_noise = noise / std::max(weight[c], 1e-12);
    gain_weight_[c] = std::sqrt(by_noise / (by_noise + scatter * scatter));
  }
  prepare();
}

void StaticFit::prepare() {
  std::vector<Eigen::MatrixXd> normal = normalMatrices();
  for (std::size_t c = 0; c < measured_.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured_.cycles[c];
    Eigen::VectorXd along = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(basis_.size()));
    double square = 0;
    for (std::size_t i = cycle.first; i < cycle.last; ++i) {
      const double gain = net_curve_[static_cast<Eigen::Index>(i)];
      square += gain * gain;
      eachSpline(splines_[i], [&](Eigen::Index k, double x, double) { along[k] += gain * x; });
    }
    if (square <= 0 || !fits_[cycle.first]) continue;
    normal[group_[cycle.first]] -=
        (1 - gain_weight_[c] * gain_weight_[c]) / square * along * along.transpose();
  }
  weighted_.clear();
  for (const Eigen::MatrixXd& matrix : normal) weighted_.push_back(decompose(matrix, bendsOf(basis_)));
}

}  // namespace fsr::discrepancy
