#include "discrepancy/fit/cycle_design.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr double kBins = 40;           // of a cycle, about
constexpr double kKnotDistance = 6e3;  // [Pa]: wider knots turn a step of the static curve into a loop
constexpr double kSudden = 0.5;  // change of the rate between two readings of the reference, of the fastest
constexpr double kFewestKnown = 1.0 / 3;  // of a cycle's samples: with fewer, all are used
constexpr double kFewestKnots = 14, kMostKnots = 40;
constexpr std::size_t kNoiseLevels = 6;  // bins of pressure for the variance of the white noise

using Index = Eigen::Index;

std::vector<double> evenKnots(double low, double high) {
  const auto number = static_cast<std::size_t>(
      std::clamp(std::round((high - low) / kKnotDistance), kFewestKnots, kMostKnots));
  std::vector<double> knots;
  for (std::size_t k = 0; k < number; ++k) {
    knots.push_back(low + (high - low) * static_cast<double>(k) / static_cast<double>(number - 1));
  }
  return knots;
}

// Samples of a cycle, without those at which the pressure is not known. Where a reference that is read more
// slowly than the sheet changes its rate, it may have done so anywhere between two readings, and the
// interpolated pressure is wrong up to the next reading but one.
std::vector<std::size_t> knownSamples(const Measured& measured, const MeasuredCycle& cycle) {
  std::vector<std::size_t> all(cycle.last - cycle.first);
  std::iota(all.begin(), all.end(), cycle.first);
  const Visit& visit = measured.visits[cycle.visit];
  const double interval = visit.reference_interval;
  const double seconds = measured.time[cycle.last - 1] - measured.time[cycle.first];
  if (interval * static_cast<double>(all.size()) < 2 * seconds) return all;
  double fastest = 0;
  for (const std::size_t i : all) fastest = std::max(fastest, std::abs(measured.rate[i]));
  std::vector<std::uint8_t> unknown(all.size(), 0);
  std::size_t after = visit.first;
  for (std::size_t before = visit.first; before < visit.last; ++before) {
    while (after < visit.last && measured.time[after] - measured.time[before] < interval) ++after;
    if (after == visit.last) break;
    if (std::abs(measured.rate[after] - measured.rate[before]) < kSudden * fastest) continue;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double time = measured.time[all[k]];
      if (time > measured.time[before] - interval && time < measured.time[after] + interval) unknown[k] = 1;
    }
  }
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!unknown[k]) known.push_back(all[k]);
  }
  return static_cast<double>(known.size()) < kFewestKnown * static_cast<double>(all.size()) ? all : known;
}

// First of the samples of each bin, and the end of the last. Bins have equal shares of time and of change of
// pressure, and end where the direction changes.
std::vector<std::size_t> cutIntoBins(const Measured& measured, const std::vector<std::size_t>& samples) {
  const auto& pressure = measured.pressure;
  double change = 0;
  for (std::size_t k = 1; k < samples.size(); ++k)
    change += std::abs(pressure[samples[k]] - pressure[samples[k - 1]]);
  const double duration = measured.time[samples.back()] - measured.time[samples.front()];
  const double wanted = 1 / std::min(kBins, static_cast<double>(samples.size()));
  std::vector<std::size_t> starts = {0};
  double along = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const std::size_t i = samples[k], before = samples[k - 1];
    along += 0.5 * std::abs(pressure[i] - pressure[before]) / std::max(change, 1e-9);
    along += 0.5 * (measured.time[i] - measured.time[before]) / std::max(duration, 1e-9);
    const bool turned = measured.direction[i] != measured.direction[before] && along > wanted / 4;
    if (along < wanted && !turned) continue;
    starts.push_back(k);
    along = 0;
  }
  starts.push_back(samples.size());
  return starts;
}

// Variance of a single scan's white noise in the common trace, by level of pressure: from second differences
// of consecutive samples, whose variance is 6 times that of the noise.
class WhiteNoise {
 public:
  WhiteNoise(const Measured& measured, const Trace& common) : measured_(measured) {
    const auto [low, high] = std::minmax_element(measured.pressure.begin(), measured.pressure.end());
    low_ = *low;
    width_ = std::max(1.0, (*high - *low) / kNoiseLevels);
    std::vector<std::vector<double>> squares(kNoiseLevels);
    std::vector<double> all;
    for (std::size_t i = 1; i + 1 < measured.samples(); ++i) {
      if (measured.cycle[i - 1] != measured.cycle[i + 1]) continue;
      if (measured.cycles[measured.cycle[i]].use == CycleUse::kHoldOut) continue;
      const auto at = static_cast<Index>(i);
      const double d = common[at - 1] - 2 * common[at] + common[at + 1];
      const double square = d * d / 6 * measured.scans[i];
      squares[levelOf(measured.pressure[i])].push_back(square);
      all.push_back(square);
    }
    constexpr double kMeanPerMedian = 2.198;  // of a squared normal variable
    const double least = std::pow(1e-6, 2);   // [share of full scale, squared]
    const double usual = kMeanPerMedian * statistics::upperMedian(all, 0);
    for (auto& level : squares) {
      const double own = level.size() < 20 ? usual : kMeanPerMedian * statistics::upperMedian(level, 0);
      variance_.push_back(std::max({own, 0.05 * usual, least}));
    }
  }
  double of(double pressure) const { return variance_[levelOf(pressure)]; }

 private:
  std::size_t levelOf(double pressure) const {
    return std::min(kNoiseLevels - 1, static_cast<std::size_t>(std::max(0.0, (pressure - low_) / width_)));
  }
  const Measured& measured_;
  double low_ = 0, width_ = 1;
  std::vector<double> variance_;
};

class Binning {
 public:
  Binning(const Measured& measured, const StaticFit& fit, const Trace& common, const Eigen::MatrixXd& columns)
      : measured_(measured),
        fit_(fit),
        common_(common),
        columns_(columns),
        white_(measured, common),
        basis_(evenKnots(*std::min_element(measured.raw_pressure.begin(), measured.raw_pressure.end()),
                         *std::max_element(measured.raw_pressure.begin(), measured.raw_pressure.end()))) {}

  Index splines() const { return static_cast<Index>(basis_.size()); }

  CycleBins of(std::size_t c) const {
    const MeasuredCycle& cycle = measured_.cycles[c];
    const std::vector<std::size_t> samples = knownSamples(measured_, cycle);
    const std::vector<std::size_t> starts = cutIntoBins(measured_, samples);
    const auto bins = static_cast<Index>(starts.size() - 1);
    CycleBins result;
    result.cycle = c;
    result.visit = cycle.visit;
    result.curvature_class = measured_.visits[cycle.visit].curvature_class;
    for (Eigen::VectorXd* v : {&result.reading, &result.net, &result.slope, &result.pressure, &result.time,
                               &result.white, &result.corner, &result.scans}) {
      v->setZero(bins);
    }
    result.splines.setZero(bins, splines());
    result.columns.setZero(bins, columns_.cols() + 1);
    for (Index b = 0; b < bins; ++b) {
      const auto bin = static_cast<std::size_t>(b);
      for (std::size_t k = starts[bin]; k < starts[bin + 1]; ++k) add(result, b, samples[k]);
      finish(result, b);
    }
    return result;
  }

 private:
  void add(CycleBins& bins, Index b, std::size_t i) const {
    const auto at = static_cast<Index>(i);
    const auto n = static_cast<double>(measured_.scans[i]);
    const double pressure = measured_.raw_pressure[i];
    bins.scans[b] += n;
    bins.reading[b] += n * common_[at];
    bins.net[b] += n * fit_.netCurve()[at];
    bins.slope[b] += n * fit_.slope()[at];
    bins.pressure[b] += n * pressure;
    bins.time[b] += n * measured_.time[i];
    bins.white[b] += n * white_.of(pressure);
    const double corner = fit_.slope()[at] * bendOf(i);
    bins.corner[b] += n * corner * corner;
    bins.columns(b, columns_.cols()) += n * corner;
    const SplineBasis::Values values = basis_.at(pressure);
    for (std::size_t k = 0; k < SplineBasis::kAtOnce; ++k)
      bins.splines(b, static_cast<Index>(values.first + k)) += n * values.value[k];
    if (columns_.cols() > 0) bins.columns.row(b).head(columns_.cols()) += n * columns_.row(at);
  }
  // Second derivative of the pressure [Pa/s^2].
  double bendOf(std::size_t i) const {
    const MeasuredCycle& cycle = measured_.cycles[measured_.cycle[i]];
    const std::size_t before = std::max(cycle.first, i - std::min<std::size_t>(i, 1));
    const std::size_t after = std::min(cycle.last - 1, i + 1);
    const double seconds = measured_.time[after] - measured_.time[before];
    return seconds > 0 ? (measured_.rate[after] - measured_.rate[before]) / seconds : 0;
  }
  static void finish(CycleBins& bins, Index b) {
    const double n = bins.scans[b];
    for (Eigen::VectorXd* v :
         {&bins.reading, &bins.net, &bins.slope, &bins.pressure, &bins.time, &bins.corner})
      (*v)[b] /= n;
    bins.white[b] /= n * n;
    bins.splines.row(b) /= n;
    bins.columns.row(b) /= n;
  }

  const Measured& measured_;
  const StaticFit& fit_;
  const Trace& common_;
  const Eigen::MatrixXd& columns_;
  WhiteNoise white_;
  SplineBasis basis_;
};

// Scales the column of the corners to rms 1.
void scaleCorners(CycleDesign& design) {
  double square = 0, bins = 0;
  for (const CycleBins& cycle : design.cycles) {
    square += cycle.columns.col(design.corners).squaredNorm();
    bins += static_cast<double>(cycle.bins());
  }
  if (!(square > 0)) return;
  for (CycleBins& cycle : design.cycles) cycle.columns.col(design.corners) *= std::sqrt(bins / square);
}

}  // namespace

CycleDesign cycleDesign(const Measured& measured, const StaticFit& fit, const Trace& common,
                        const Eigen::MatrixXd& columns, const std::vector<Eigen::Index>& always) {
  const Binning binning(measured, fit, common, columns);
  CycleDesign design;
  design.classes = measured.classes.size();
  design.visits = measured.visits.size();
  design.splines = binning.splines();
  design.corners = columns.cols();
  design.columns = columns.cols() + 1;
  design.always = always;
  design.always.push_back(design.corners);
  for (const dataset::CurvatureClass& one : measured.classes) design.flat.push_back(dataset::isFlat(one));
  std::vector<std::size_t> visits_of(design.classes);
  for (const Visit& visit : measured.visits) ++visits_of[visit.curvature_class];
  for (const Visit& visit : measured.visits) design.class_of.push_back(visit.curvature_class);
  for (const Visit& visit : measured.visits)
    design.visited_again.push_back(visits_of[visit.curvature_class] > 1);
  const auto [low, high] = std::minmax_element(measured.raw_pressure.begin(), measured.raw_pressure.end());
  design.range = *high - *low;
  std::vector<double> durations;
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured.cycles[c];
    if (cycle.use == CycleUse::kHoldOut || cycle.last - cycle.first < 4) continue;
    design.cycles.push_back(binning.of(c));
    durations.push_back(measured.time[cycle.last - 1] - measured.time[cycle.first]);
  }
  scaleCorners(design);
  design.cycle_time = std::max(1e-3, statistics::upperMedian(durations, 1));
  return design;
}

}  // namespace fsr::discrepancy
