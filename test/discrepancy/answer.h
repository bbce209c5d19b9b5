#pragma once

#include <gtest/gtest.h>

#include "discrepancy/contradictions.h"
#include "discrepancy/planted.h"
#include "discrepancy/prove/recompute_gap.h"
#include "simulation/settings_text.h"
#include "simulation/taxel_curves.h"

namespace fsr::discrepancy {

constexpr double kNoise = 8.0 / 4095;  ///< White noise of the planted rigs [share of full scale].

/// As written into files, with the digits of the files.
inline simulation::SimulationSettings written(const simulation::SimulationSettings& settings) {
  simulation::SimulationSettings plain = settings;
  plain.taxel_curves.reset();
  plain.taxel_curves_file.clear();
  simulation::SimulationSettings read = simulation::readSimulation(
      settings::Settings::fromText(simulation::simulationText(plain), "written.yaml"));
  read.taxel_curves = settings.taxel_curves;
  return read;
}

inline void expectRecomputable(const DiscrepancyProblem& problem, const DiscrepancyReport& report) {
  const std::pair<simulation::SimulationSettings, bool> sides[] = {{report.base, false},
                                                                   {report.added, true}};
  for (const auto& [settings, after] : sides) {
    const RecomputedGap again = recomputeGap(problem.recordings, report.hold_out, written(settings));
    const double stated = after ? report.gap.after : report.gap.before;
    EXPECT_NEAR(again.rms, stated, 1e-3 * stated) << after;
    ASSERT_EQ(again.surfaces.size(), report.gap.surfaces.size());
    for (std::size_t s = 0; s < again.surfaces.size(); ++s) {
      const SurfaceGap& surface = report.gap.surfaces[s];
      EXPECT_EQ(again.surfaces[s].first, surface.surface);
      EXPECT_NEAR(again.surfaces[s].second, after ? surface.after : surface.before, 1e-3 * stated);
    }
  }
}

/// Whether a member of the credible set contains the effect.
inline bool inSet(const DiscrepancyReport& report, const std::string& id) {
  return std::any_of(report.credible_set.begin(), report.credible_set.end(),
                     [&](const auto& ids) { return std::count(ids.begin(), ids.end(), id) > 0; });
}

/// The report on a problem. Whatever it says, its statements agree, and the gaps that it states are those of
/// its simulations, driven through the recordings.
inline DiscrepancyReport answerTo(const DiscrepancyProblem& problem) {
  const DiscrepancyReport report = investigate(problem);
  for (const std::string& sentence : test_support::contradictions(report))
    ADD_FAILURE() << sentence << "\n" << report.sentence;
  if (!report.hold_out.empty()) expectRecomputable(problem, report);
  return report;
}

}  // namespace fsr::discrepancy
