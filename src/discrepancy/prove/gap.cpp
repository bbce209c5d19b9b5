#include "discrepancy/prove/gap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"
#include "matrix/for_each_taxel.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr int kDraws = 400;  // of the bootstrap

Interval middle95(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); }),
               values.end());
  if (values.empty()) return {NAN, NAN};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.025), at(0.975)};
}

}  // namespace

void setIntervals(std::size_t cycles, std::uint64_t seed,
                  const std::function<Gap(const std::vector<std::size_t>& chosen)>& of, Gap& gap) {
  const statistics::RandomStream stream = statistics::randomStream(seed, "discrepancy.gap");
  std::vector<double> before, after, floor, closed;
  std::vector<std::size_t> chosen(cycles);
  for (int draw = 0; draw < kDraws && cycles > 0; ++draw) {
    for (std::size_t c = 0; c < cycles; ++c)
      chosen[c] = stream.bits(static_cast<std::uint64_t>(draw) * cycles + c) % cycles;
    const Gap one = of(chosen);
    before.push_back(one.before);
    after.push_back(one.after);
    floor.push_back(one.floor);
    closed.push_back(one.closed);
  }
  gap.before_interval = middle95(before);
  gap.after_interval = middle95(after);
  gap.floor_interval = middle95(floor);
  gap.closed_interval = middle95(closed);
}

namespace {

constexpr double kDirectionShows = 0.1;  // share of the squared trace; a direction with less does not show it
constexpr double kSureAmplitude = 3;     // standard errors by which the amplitude of a taxel must exceed 0
constexpr std::size_t kCurvePoints = 24;

double ofClass(const Measured& measured, const Trace& left, std::size_t wanted) {
  double squares = 0, number = 0;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.classOf(i) != wanted) continue;
    squares += std::pow(left[static_cast<Eigen::Index>(i)], 2);
    ++number;
  }
  return number > 0 ? std::sqrt(squares / number) : 0;
}

Interval pressuresOf(const Measured& measured, const Trace& left) {
  std::map<long, std::pair<double, double>> bins;  // sum of squares, number of samples
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    auto& bin =
        bins[static_cast<long>(std::floor(std::max(0.0, measured.pressure[i]) / thresholds::kPressureBin))];
    bin.first += std::pow(left[static_cast<Eigen::Index>(i)], 2);
    bin.second += 1;
  }
  double most = 0;
  for (const auto& [bin, sums] : bins) most = std::max(most, std::sqrt(sums.first / sums.second));
  Interval range{INFINITY, 0};
  for (const auto& [bin, sums] : bins) {
    if (std::sqrt(sums.first / sums.second) < thresholds::kPressureShows * most) continue;
    range.low = std::min(range.low, static_cast<double>(bin) * thresholds::kPressureBin);
    range.high = std::max(range.high, static_cast<double>(bin + 1) * thresholds::kPressureBin);
  }
  return range;
}

std::string directionOf(const Measured& measured, const Trace& left) {
  double loading = 0, unloading = 0;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const double square = std::pow(left[static_cast<Eigen::Index>(i)], 2);
    (measured.direction[i] > 0 ? loading : unloading) += square;
  }
  const double sum = loading + unloading;
  if (loading < kDirectionShows * sum) return "unloading";
  return unloading < kDirectionShows * sum ? "loading" : "both";
}

// Sums over the readings of one cycle.
struct CycleSums {
  // Squared errors [share of full scale, squared], and number of readings.
  double before = 0, after = 0, number = 0;
  double before_pressure = 0, after_pressure = 0;  // the same divided by the squared local slope [Pa^2]
  double in_pressure = 0;                          // number of readings where the slope is steep enough
};

CycleSums sumsOf(const GapGround& ground, const Trace& left, const MeasuredCycle& cycle) {
  const double steepest = ground.fit.slope().maxCoeff(), within = ground.taxels.within();
  CycleSums sum;
  std::vector<double> residual;
  for (std::size_t i = cycle.first; i < cycle.last; ++i) {
    ground.taxels.residuals(i, residual);
    const auto at = static_cast<Eigen::Index>(i), c = static_cast<Eigen::Index>(ground.measured.classOf(i));
    const double slope = ground.fit.slope()[at];
    for (std::size_t t = 0; t < residual.size(); ++t) {
      if (!ground.measured.used[t]) continue;
      const double before = residual[t] * residual[t];
      const double after = std::pow(residual[t] - ground.mask(static_cast<Eigen::Index>(t), c) * left[at], 2);
      sum.before += before + within;
      sum.after += after + within;
      ++sum.number;
      if (!(slope > 0) || slope < 0.05 * steepest) continue;
      sum.before_pressure += (before + within) / (slope * slope);
      sum.after_pressure += (after + within) / (slope * slope);
      ++sum.in_pressure;
    }
  }
  return sum;
}

// Computes the gap from the sums of the chosen cycles and the share of the error that can be explained.
Gap gapOf(const std::vector<CycleSums>& sums, const std::vector<std::size_t>& chosen, double explainable,
          const GapExtras& extras) {
  CycleSums total;
  for (const std::size_t c : chosen) {
    total.before += sums[c].before;
    total.after += sums[c].after;
    total.number += sums[c].number;
    total.before_pressure += sums[c].before_pressure;
    total.after_pressure += sums[c].after_pressure;
    total.in_pressure += sums[c].in_pressure;
  }
  Gap gap;
  // Where the curve rises nowhere, an error tells no pressure.
  const double n = std::max(1.0, total.number), np = total.in_pressure > 0 ? total.in_pressure : NAN;
  const double common = total.before / n, before = common + extras.before_more;
  const double after = std::max(0.0, total.after / n - extras.after_less);
  const double floor = std::min(after, common * (1 - explainable));
  gap.before = std::sqrt(before);
  gap.after = std::sqrt(after);
  gap.floor = std::sqrt(std::max(0.0, floor));
  gap.closed = before > floor * (1 + 1e-9) ? (before - after) / (before - floor) : NAN;
  gap.before_pressure = std::sqrt(total.before_pressure / np);
  gap.after_pressure = std::sqrt(total.after_pressure / np);
  if (common > 0) gap.before_pressure *= std::sqrt(before / common);
  if (total.after > 0) gap.after_pressure *= std::sqrt(after / (total.after / n));
  gap.floor_pressure = gap.before > 0 ? gap.before_pressure * gap.floor / gap.before : 0;
  return gap;
}

struct Axis {
  const char* covariate;
  const char* unit;
  std::function<double(std::size_t)> at;
};

ResidualCurve curveOver(const Measured& measured, const Axis& axis, const Trace& before, const Trace& after) {
  ResidualCurve curve{axis.covariate, axis.unit, {}, {}, {}, {}};
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    low = std::min(low, axis.at(i));
    high = std::max(high, axis.at(i));
  }
  if (!(high > low)) return curve;
  std::vector<double> n(kCurvePoints), b(kCurvePoints), a(kCurvePoints), squares(kCurvePoints);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const double share = (axis.at(i) - low) / (high - low);
    const auto bin = std::min(kCurvePoints - 1, static_cast<std::size_t>(share * kCurvePoints));
    const auto at = static_cast<Eigen::Index>(i);
    n[bin] += 1;
    b[bin] += before[at];
    a[bin] += after[at];
    squares[bin] += after[at] * after[at];
  }
  for (std::size_t k = 0; k < kCurvePoints; ++k) {
    if (n[k] < 2) continue;
    curve.at.push_back(low + (high - low) * (static_cast<double>(k) + 0.5) / kCurvePoints);
    curve.before.push_back(b[k] / n[k]);
    curve.after.push_back(a[k] / n[k]);
    curve.error.push_back(std::sqrt(squares[k]) / n[k]);
  }
  return curve;
}

}  // namespace

WhereItShows placeOf(const Measured& measured, const Trace& left, const Spread& spread) {
  const auto rows = spread.amplitude.rows(), classes = spread.amplitude.cols();
  Eigen::VectorXd by_taxel = Eigen::VectorXd::Zero(rows), error = by_taxel,
                  by_class = Eigen::VectorXd::Zero(classes);
  double used = 0;
  for (Eigen::Index c = 0; c < classes; ++c) {
    const double rms = ofClass(measured, left, static_cast<std::size_t>(c));
    double sum = 0, number = 0;
    for (Eigen::Index t = 0; t < rows; ++t) {
      if (std::isnan(spread.amplitude(t, c))) continue;
      by_taxel[t] += spread.amplitude(t, c) * rms * rms;
      error[t] += std::pow(spread.error(t, c) * rms * rms, 2);
      sum += spread.amplitude(t, c);
      ++number;
    }
    by_class[c] = number > 0 ? sum / number * rms : 0;
    used = std::max(used, number);
  }
  WhereItShows where;
  const double most = by_taxel.maxCoeff(), most_class = by_class.maxCoeff();
  for (Eigen::Index t = 0; t < rows; ++t) {
    const bool sure = by_taxel[t] > kSureAmplitude * std::sqrt(error[t]) ||
                      kSureAmplitude * std::sqrt(error[t]) > 0.5 * most;
    if (by_taxel[t] >= thresholds::kShows * most && sure) where.taxels.push_back(static_cast<std::size_t>(t));
  }
  if (static_cast<double>(where.taxels.size()) >= used) where.taxels.clear();
  for (Eigen::Index c = 0; c < classes; ++c) {
    if (by_class[c] >= thresholds::kShows * most_class) {
      where.conditions.push_back(measured.classes[static_cast<std::size_t>(c)].surface);
    }
  }
  if (where.conditions.size() == measured.classes.size()) where.conditions.clear();
  where.pressure = pressuresOf(measured, left);
  where.direction = directionOf(measured, left);
  return where;
}

Eigen::MatrixXd maskOf(const Measured& measured, const WhereItShows& where, const Spread& spread) {
  Eigen::MatrixXd mask = Eigen::MatrixXd::Zero(spread.amplitude.rows(), spread.amplitude.cols());
  double sum = 0, weights = 0;
  const auto in = [](const auto& list, const auto& member) {
    return list.empty() || std::count(list.begin(), list.end(), member) > 0;
  };
  for (Eigen::Index c = 0; c < mask.cols(); ++c) {
    for (Eigen::Index t = 0; t < mask.rows(); ++t) {
      const auto taxel = static_cast<std::size_t>(t);
      if (!measured.used[taxel] || !in(where.taxels, taxel) ||
          !in(where.conditions, measured.classes[static_cast<std::size_t>(c)].surface)) {
        continue;
      }
      if (std::isnan(spread.amplitude(t, c))) continue;
      mask(t, c) = 1;
      // Weighted least squares: where the trace hardly changes, the amplitude is uncertain.
      const double weight = 1 / (std::pow(spread.error(t, c), 2) + 1e-12);
      sum += weight * spread.amplitude(t, c);
      weights += weight;
    }
  }
  return weights > 0 ? Eigen::MatrixXd(mask * (sum / weights)) : mask;
}

std::vector<std::size_t> allCycles(const Measured& measured) {
  std::vector<std::size_t> all(measured.cycles.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Gap measureGap(const GapGround& ground, const Trace& left, const std::vector<std::size_t>& cycles) {
  std::vector<CycleSums> sums;
  for (const std::size_t c : cycles) {
    const MeasuredCycle& cycle = ground.measured.cycles[c];
    if (cycle.use == CycleUse::kHoldOut) sums.push_back(sumsOf(ground, left, cycle));
  }
  std::vector<std::size_t> all(sums.size());
  std::iota(all.begin(), all.end(), 0);
  Gap gap = gapOf(sums, all, ground.explainable, ground.extras);
  setIntervals(
      sums.size(), ground.seed,
      [&](const std::vector<std::size_t>& chosen) {
        return gapOf(sums, chosen, ground.explainable, ground.extras);
      },
      gap);
  if (!all.empty()) gap.held_out_by = {"cycles"};
  return gap;
}

Trace predictedByTheRest(const Measured& measured, const std::vector<Part>& parts, unsigned threads,
                         const std::function<Trace(const Part& part)>& left) {
  std::vector<Trace> without(parts.size());
  matrix::forEachTaxel(parts.size(), threads, [&](std::size_t p) { without[p] = left(parts[p]); });
  Trace foretold = Trace::Zero(static_cast<Eigen::Index>(measured.samples()));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const std::size_t c : parts[p].cycles) {
      const auto first = static_cast<Eigen::Index>(measured.cycles[c].first);
      const auto samples = static_cast<Eigen::Index>(measured.cycles[c].last) - first;
      foretold.segment(first, samples) = without[p].segment(first, samples);
    }
  }
  return foretold;
}

std::vector<ResidualCurve> residualCurves(const Measured& measured, const Trace& before, const Trace& after) {
  const auto pressure = [&](std::size_t i) { return measured.pressure[i]; };
  const std::vector<Axis> axes = {
      {"pressure", "Pa", pressure},
      {"direction", "Pa, venting negative",
       [&](std::size_t i) {
         return measured.direction[i] < 0 ? -measured.pressure[i] : measured.pressure[i];
       }},
      {"pressure_rate", "Pa/s", [&](std::size_t i) { return measured.rate[i]; }},
      {"clock_time", "s", [&](std::size_t i) { return measured.time[i]; }},
      {"cycle", "", [&](std::size_t i) { return static_cast<double>(measured.cycle[i]); }},
      {"accumulated_change", "Pa", [&](std::size_t i) { return measured.path_length[i]; }},
  };
  std::vector<ResidualCurve> curves;
  for (const Axis& axis : axes) {
    curves.push_back(curveOver(measured, axis, before, after));
    if (curves.back().at.size() < 2) curves.pop_back();
  }
  return curves;
}

}  // namespace fsr::discrepancy
