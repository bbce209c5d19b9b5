// The reduction of the common trace and of all columns to bins.
#include "discrepancy/fit/cycle_design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/planted.h"

namespace fsr::discrepancy {
namespace {

constexpr double kStep = 0.1;                 // from sample to sample [s]
constexpr std::size_t kUp = 93, kDown = 107;  // samples of one cycle
constexpr double kHighest = 600e3;            // [Pa]
constexpr double kSlope = 1e-6;               // of the reading [share of full scale / Pa]
constexpr std::size_t kCycles = 6, kHeldOut = 2;

// Triangular cycles on one flat surface, without a recording.
Measured triangles() {
  Measured measured;
  measured.classes = {{"flat", {0.0}}};
  measured.used = {1};
  measured.layout.size = {1, 1};
  measured.full_scale = 1024;
  const std::size_t samples = kCycles * (kUp + kDown);
  Visit visit;
  visit.surface.curvature = {{}};
  visit.last = visit.last_scan = samples;
  measured.visits = {visit};
  for (std::size_t c = 0; c < kCycles; ++c) {
    MeasuredCycle cycle;
    cycle.first = c * (kUp + kDown);
    cycle.last = cycle.first + kUp + kDown;
    cycle.use = c == kHeldOut ? CycleUse::kHoldOut : CycleUse::kFit;
    measured.cycles.push_back(cycle);
  }
  const double up = kHighest / (kUp * kStep), down = kHighest / (kDown * kStep);
  double pressure = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t inside = i % (kUp + kDown);
    const bool rises = inside < kUp;
    measured.time.push_back(kStep * static_cast<double>(i));
    measured.pressure.push_back(pressure);
    measured.raw_pressure.push_back(pressure);
    measured.rate.push_back(rises ? up : -down);
    pressure = std::max(0.0, pressure + kStep * measured.rate.back());
    measured.path_length.push_back(0);
    measured.visit.push_back(0);
    measured.cycle.push_back(static_cast<std::uint32_t>(i / (kUp + kDown)));
    measured.direction.push_back(rises ? 1 : -1);
    measured.first_scan.push_back(i);
    measured.scans.push_back(static_cast<std::uint32_t>(1 + i % 3));  // as if some scans were pooled
  }
  return measured;
}

Trace reading(const Measured& measured) {
  Trace trace(static_cast<Eigen::Index>(measured.samples()));
  for (std::size_t i = 0; i < measured.samples(); ++i)
    trace[static_cast<Eigen::Index>(i)] = 0.01 + kSlope * measured.pressure[i];
  return trace;
}

// Two columns that are not smooth.
Eigen::MatrixXd columns(const Measured& measured) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(measured.samples()), 2);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    columns(i, 0) = std::sin(2.0 * static_cast<double>(i));
    columns(i, 1) = static_cast<double>(i % 7);
  }
  return columns;
}

CycleDesign designOf(const Measured& measured, const Trace& common) {
  return cycleDesign(measured, StaticFit(measured, CurvePer::kClass, reading(measured)), common,
                     columns(measured));
}

// First sample of each bin, and the end of the last: bins hold whole samples in their order.
std::vector<std::size_t> startsOf(const Measured& measured, const CycleBins& bins) {
  std::vector<std::size_t> starts = {measured.cycles[bins.cycle].first};
  for (Eigen::Index b = 0; b < bins.bins(); ++b) {
    double scans = 0;
    std::size_t i = starts.back();
    while (i < measured.cycles[bins.cycle].last && scans < bins.scans[b]) scans += measured.scans[i++];
    EXPECT_EQ(scans, bins.scans[b]);
    starts.push_back(i);
  }
  EXPECT_EQ(starts.back(), measured.cycles[bins.cycle].last) << "no sample is lost";
  return starts;
}

TEST(CycleDesign, BinsAreMeansOverTheirScans) {
  const Measured measured = triangles();
  const Trace common = reading(measured);
  const Eigen::MatrixXd all = columns(measured);
  const CycleDesign design = designOf(measured, common);
  // 600 kPa in knots of 6 kPa would be 100; at most 40 are used, and a cubic spline has 2 coefficients more.
  ASSERT_EQ(design.splines, 42);
  std::vector<double> knots;
  const double highest = *std::max_element(measured.raw_pressure.begin(), measured.raw_pressure.end());
  for (int k = 0; k < 40; ++k) knots.push_back(highest * k / 39);
  const SplineBasis basis(knots);
  for (const CycleBins& bins : design.cycles) {
    const std::vector<std::size_t> starts = startsOf(measured, bins);
    for (Eigen::Index b = 0; b < bins.bins(); ++b) {
      double scans = 0, y = 0, p = 0, t = 0;
      Eigen::RowVectorXd splines = Eigen::RowVectorXd::Zero(42), of = Eigen::RowVectorXd::Zero(2);
      for (std::size_t i = starts[static_cast<std::size_t>(b)]; i < starts[static_cast<std::size_t>(b) + 1];
           ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const double n = measured.scans[i];
        scans += n;
        y += n * common[at];
        p += n * measured.raw_pressure[i];
        t += n * measured.time[i];
        of += n * all.row(at);
        const SplineBasis::Values values = basis.at(measured.raw_pressure[i]);
        for (std::size_t k = 0; k < SplineBasis::kAtOnce; ++k)
          splines[static_cast<Eigen::Index>(values.first + k)] += n * values.value[k];
      }
      EXPECT_NEAR(bins.reading[b], y / scans, 1e-14);
      EXPECT_NEAR(bins.pressure[b], p / scans, 1e-8);
      EXPECT_NEAR(bins.time[b], t / scans, 1e-10);
      EXPECT_LT((bins.splines.row(b) - splines / scans).norm(), 1e-12);
      EXPECT_LT((bins.columns.row(b).head(2) - of / scans).norm(), 1e-12);
      EXPECT_NEAR(bins.slope[b], kSlope, 1e-9 * kSlope + 1e-12);
    }
  }
}

TEST(CycleDesign, HasAboutFortyBinsACycleAndCutsThemWhereTheDirectionChanges) {
  const Measured measured = triangles();
  const CycleDesign design = designOf(measured, reading(measured));
  for (const CycleBins& bins : design.cycles) {
    EXPECT_GE(bins.bins(), 36) << "bins hold whole samples, here about 5";
    EXPECT_LE(bins.bins(), 44);
    const std::vector<std::size_t> starts = startsOf(measured, bins);
    for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
      const auto last = starts[b + 1] - 1;
      EXPECT_EQ(measured.direction[starts[b]], measured.direction[last]) << "bin " << b;
    }
  }
}

// What the hold-out cycles read is not looked at, not even for the variance of the white noise.
TEST(CycleDesign, LeavesTheHoldOutCyclesOut) {
  const Measured measured = triangles();
  Trace common = reading(measured);
  for (Eigen::Index i = 0; i < common.size(); ++i) common[i] += 1e-4 * std::cos(2.5 * static_cast<double>(i));
  Trace other = common;
  const MeasuredCycle& held = measured.cycles[kHeldOut];
  for (std::size_t i = held.first; i < held.last; ++i)
    other[static_cast<Eigen::Index>(i)] = 0.1 * std::cos(3.0 * static_cast<double>(i));
  const CycleDesign a = designOf(measured, common), b = designOf(measured, other);
  ASSERT_EQ(a.cycles.size(), kCycles - 1);
  ASSERT_EQ(b.cycles.size(), kCycles - 1);
  for (std::size_t c = 0; c < a.cycles.size(); ++c) {
    EXPECT_NE(a.cycles[c].cycle, kHeldOut);
    EXPECT_EQ(a.cycles[c].reading, b.cycles[c].reading);
    EXPECT_EQ(a.cycles[c].white, b.cycles[c].white);
  }
}

// The pressure bends only where a cycle turns. Beside a corner the central difference of the rate is
// (-down - up) / (2 steps), at the two samples next to it; the rate of the other samples does not change.
TEST(CycleDesign, KnowsTheCornersOfThePressure) {
  const Measured measured = triangles();
  const CycleDesign design = designOf(measured, reading(measured));
  const double bend = (kHighest / (kUp * kStep) + kHighest / (kDown * kStep)) / (2 * kStep);
  double square = 0, number = 0;
  for (const CycleBins& bins : design.cycles) {
    const std::vector<std::size_t> starts = startsOf(measured, bins);
    const std::size_t first = measured.cycles[bins.cycle].first;
    for (Eigen::Index b = 0; b < bins.bins(); ++b) {
      const std::size_t from = starts[static_cast<std::size_t>(b)] - first,
                        to = starts[static_cast<std::size_t>(b) + 1] - first;
      double corner = 0;
      for (const std::size_t at : {kUp - 1, kUp}) {
        if (at >= from && at < to)
          corner += measured.scans[first + at] * std::pow(kSlope * bend, 2) / bins.scans[b];
      }
      EXPECT_NEAR(bins.corner[b], corner, 1e-6 * std::pow(kSlope * bend, 2));
      const double column = bins.columns(b, design.corners);
      if (corner == 0) {
        EXPECT_NEAR(column, 0, 1e-6);
      } else {
        EXPECT_LT(column, -0.1) << "the rate falls at a peak";
      }
      square += column * column;
      ++number;
    }
  }
  EXPECT_NEAR(square / number, 1, 1e-12) << "scaled to rms 1";
}

// White noise of 8 counts in each of 12 taxels, a converter of 1 count: sqrt((64 + 1/12) / 12) = 2.31 counts
// in the mean of one scan.
TEST(CycleDesign, EstimatesTheWhiteNoiseOfABin) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  const CycleDesign design = cycleDesign(measured, fit, common.all, Eigen::MatrixXd(common.all.size(), 0));
  double scan = 0, bins = 0;
  for (const CycleBins& cycle : design.cycles) {
    scan += cycle.white.cwiseProduct(cycle.scans).sum();
    bins += static_cast<double>(cycle.bins());
  }
  EXPECT_NEAR(std::sqrt(scan / bins) * measured.full_scale, 2.31, 0.35);
}

// One surface was recorded with a reference that reads 5 kPa less. The curves of the others must not end in
// whatever a spline does where it has no data.
TEST(StaticFit, ContinuesEachCurveAsAStraightLineBeyondItsOwnPressures) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  for (double& pressure : problem.recordings.back().pressure) pressure -= 5e3;
  const Measured measured = admit(problem);
  const StaticFit fit(measured, CurvePer::kClass, commonTraces(measured).all);
  const double rest = fit.curveAt(0, 0), below = fit.curveAt(0, -2e3), far = fit.curveAt(0, -4e3);
  EXPECT_LE(below, rest);
  EXPECT_LE(far, below);
  EXPECT_GE(far, std::min(fit.unloaded(), rest));
}

TEST(CycleDesign, TellsSurfacesAndRangeOfTheRecordings) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const CycleDesign design = cycleDesign(measured, StaticFit(measured, CurvePer::kClass, common.all),
                                         common.all, Eigen::MatrixXd(common.all.size(), 0));
  EXPECT_EQ(design.classes, 3u);
  EXPECT_EQ(design.flat, (std::vector<bool>{true, false, false}));
  EXPECT_EQ(design.class_of, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(design.visited_again, (std::vector<bool>{false, false, false}));
  EXPECT_NEAR(design.range, 620e3, 20e3);
  EXPECT_EQ(design.columns, 1) << "the corners";
  EXPECT_NEAR(design.cycle_time, 39, 3) << "most cycles: 620 kPa at 40 kPa/s up and down, 8 s above";
}

}  // namespace
}  // namespace fsr::discrepancy
