// Samples that may be fitted and samples that only the proof may use.
#include "discrepancy/samples/views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "discrepancy/planted.h"

namespace fsr::discrepancy {
namespace {

static_assert(!std::is_convertible_v<HoldOutView, FitView> && !std::is_constructible_v<FitView, HoldOutView>);
static_assert(!std::is_convertible_v<FitView, HoldOutView> && !std::is_convertible_v<Measured, HoldOutView>);

std::size_t scansIn(const DiscrepancyProblem& problem, const std::vector<HoldOutCycles>& bags) {
  std::size_t scans = 0;
  for (const dataset::Recording& recording : problem.recordings) {
    for (const HoldOutCycles& bag : bags) {
      if (bag.file != recording.name) continue;
      for (const double time : recording.time) {
        const std::int64_t stamp = recording.start_ns + std::llround(time * 1e9);
        for (const auto& [first, last] : bag.cycles) scans += stamp >= first && stamp <= last;
      }
    }
  }
  return scans;
}

TEST(Views, AScanIsFittedOrHeldOutAndTheSpansListIt) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(problem);
  const FitView fit(measured);
  const HoldOutView hold_out(measured, fit);
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    for (std::size_t i = 0; i < problem.recordings[r].scans(); ++i) {
      const bool fitted = fit.sampleOf(r, i) != FitView::kNotInView;
      const bool held = hold_out.sampleOf(r, i) != HoldOutView::kNotInView;
      EXPECT_FALSE(fitted && held);
      if (held) {
        EXPECT_EQ(measured.cycles[hold_out.cycleOf(hold_out.sampleOf(r, i))].use, CycleUse::kHoldOut);
      }
    }
  }
  EXPECT_GT(hold_out.scans(), 0u);
  EXPECT_GT(fit.scans(), 3 * hold_out.scans());
  const std::vector<HoldOutCycles> spans = hold_out.spans();
  EXPECT_EQ(spans.size(), 3u);
  EXPECT_EQ(scansIn(problem, spans), hold_out.scans());
}

// A hold-out cycle that goes to 1.2 times the pressure of all others on its surface.
TEST(Views, LeavesOutAndCountsScansBeyondTheFittedPressures) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured plain = admit(problem);
  std::size_t beyond = 0;
  for (const MeasuredCycle& cycle : plain.cycles) {
    if (cycle.use != CycleUse::kHoldOut) continue;
    dataset::Recording& recording = problem.recordings[plain.visits[cycle.visit].recording];
    for (std::size_t m = cycle.first; m < cycle.last; ++m) {
      for (std::size_t i = plain.first_scan[m]; i < plain.first_scan[m] + plain.scans[m]; ++i) {
        recording.pressure[i] *= 1.2;
        beyond += recording.pressure[i] > 625e3;
      }
    }
    break;
  }
  const Measured measured = admit(problem);
  const FitView fit(measured);
  const HoldOutView hold_out(measured, fit);
  EXPECT_GT(beyond, 10u);
  EXPECT_NEAR(static_cast<double>(hold_out.leftOut()), static_cast<double>(beyond),
              0.2 * static_cast<double>(beyond));
  EXPECT_EQ(scansIn(problem, hold_out.spans()), hold_out.scans());
  for (std::size_t c = 0; c < fit.classes(); ++c) EXPECT_LT(fit.covered(c).high, 630e3);
}

// The last bag was stopped with Ctrl-C at the peak of a cycle.
TEST(Views, ACycleThatWasCutOffIsNotHeldOutAndIsNoProtocolOfItsOwn) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  dataset::Recording& last = problem.recordings.back();
  std::size_t scans = last.scans();
  while (last.pressure[scans - 1] < 600e3) --scans;
  last.time.resize(scans);
  last.pressure.resize(scans);
  last.condition.resize(scans);
  last.counts.resize(scans * last.layout.size.taxels());
  if (!last.temperature.empty()) last.temperature.resize(scans);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    problem.options.seed = seed;
    EXPECT_NE(admit(problem).cycles.back().use, CycleUse::kHoldOut) << seed;
  }
}

// As a bag reader gives them: `recordings` without the scans near a change of surface, `whole` with them.
TEST(Views, ShowEveryScanToTheSimulationAndFitOnlyThoseThatWereAdmitted) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  problem.whole = problem.recordings;
  dataset::Recording& first = problem.recordings.front();
  const auto drop = [&](auto& list, std::size_t width) {
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(3 * width));
  };
  drop(first.time, 1);
  drop(first.pressure, 1);
  drop(first.condition, 1);
  drop(first.counts, first.layout.size.taxels());
  if (!first.temperature.empty()) drop(first.temperature, 1);
  const Measured measured = admit(problem);
  const FitView fit(measured);
  ASSERT_EQ(fit.recordings().front()->scans(), first.scans() + 3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(fit.sampleOf(0, i), FitView::kNotInView);
  const std::uint32_t sample = fit.sampleOf(0, 203);
  if (sample != FitView::kNotInView) {
    EXPECT_LE(measured.first_scan[sample], 200u);
    EXPECT_GT(measured.first_scan[sample] + measured.scans[sample], 200u);
  }
}

}  // namespace
}  // namespace fsr::discrepancy
