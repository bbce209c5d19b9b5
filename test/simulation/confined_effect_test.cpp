// Effects that act on some taxels or surfaces only.
#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/session.h"
#include "simulation/settings_text.h"

namespace fsr::simulation {
namespace {

const char* const kTwoSurfaces = R"(
simulation: confined
matrix: {rows: 2, columns: 3}
board: {scan_rate: 2, transducer_rate: 2}
chamber: {cycles: 1}
session:
  - {surface: flat, flat: true}
  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}}
effects:
  static_curve: {}
  converter: {}
)";

SimulationSettings settings(const std::string& more) {
  return readSimulation(settings::Settings::fromText(kTwoSurfaces + more, "confined.yaml"));
}

// Whether a taxel reads otherwise anywhere in a recording.
bool differs(const dataset::Recording& a, const dataset::Recording& b, std::size_t taxel) {
  for (std::size_t i = 0; i < a.scans(); ++i) {
    if (a.scan(i)[taxel] != b.scan(i)[taxel]) return true;
  }
  return false;
}

TEST(ConfinedEffect, ActsOnItsTaxelsAndItsSurfacesAlone) {
  const auto plain = simulateSession(settings(""));
  const auto loop = simulateSession(
      settings("  hysteresis: {loop_width: 0.1, only_taxels: [1, 5], only_surfaces: [cylinder_5cm]}\n"));
  for (std::size_t taxel = 0; taxel < 6; ++taxel) {
    EXPECT_FALSE(differs(plain[0], loop[0], taxel)) << taxel;
    EXPECT_EQ(differs(plain[1], loop[1], taxel), taxel == 1 || taxel == 5) << taxel;
  }
}

TEST(ConfinedEffect, EverywhereIsAsIfNothingWereSaid) {
  const auto all = simulateSession(settings("  creep: {}\n"));
  const auto listed = simulateSession(
      settings("  creep: {only_taxels: [0, 1, 2, 3, 4, 5], only_surfaces: [flat, cylinder_5cm]}\n"));
  for (std::size_t r = 0; r < all.size(); ++r) EXPECT_EQ(all[r].counts, listed[r].counts);
}

// The second surface reads as on a sheet that was never on the first one.
TEST(ConfinedEffect, ForgetsAtEachMountingWhereItIsNotCarriedOver) {
  std::string alone = kTwoSurfaces;
  const std::string first = "  - {surface: flat, flat: true}\n";
  alone.erase(alone.find(first), first.size());
  const auto fresh = simulateSession(
      readSimulation(settings::Settings::fromText(alone + "  creep: {per_decade: 0.2}\n", "alone.yaml")));
  const auto anew = simulateSession(settings("  creep: {per_decade: 0.2, carried_over: false}\n"));
  const auto kept = simulateSession(settings("  creep: {per_decade: 0.2}\n"));
  EXPECT_EQ(anew[1].counts, fresh[0].counts);
  EXPECT_NE(kept[1].counts, fresh[0].counts);
}

TEST(ConfinedEffect, SurvivesSavingAndLoading) {
  const SimulationSettings written = settings(
      "  hysteresis: {only_taxels: [1, 5], only_surfaces: [cylinder_5cm, \"a, b\"], carried_over: false}\n"
      "  stuck_taxel: {spells: [1, 2.5, 3, -1, 5, 7, 1e9, 400]}\n"
      "  row_fault: {spells: [1, 2, 3, 0.5]}\n");
  const SimulationSettings read =
      readSimulation(settings::Settings::fromText(simulationText(written), "written.yaml"));
  EXPECT_EQ(read.effect("hysteresis")->only_taxels, (std::vector<std::size_t>{1, 5}));
  EXPECT_FALSE(read.effect("hysteresis")->carried_over);
  EXPECT_TRUE(read.effect("row_fault")->carried_over);
  EXPECT_EQ(read.effect("hysteresis")->only_surfaces, (std::vector<std::string>{"cylinder_5cm", "a, b"}));
  const std::vector<FaultSpell>& spells = read.effect("stuck_taxel")->spells;
  ASSERT_EQ(spells.size(), 2u);
  EXPECT_EQ(std::make_tuple(spells[0].taxel, spells[0].from, spells[0].to, spells[0].reading),
            std::make_tuple(1u, 2.5, 3.0, -1.0));
  EXPECT_EQ(std::make_tuple(spells[1].taxel, spells[1].to, spells[1].reading),
            std::make_tuple(5u, kForever, 400.0));
  ASSERT_EQ(read.effect("row_fault")->spells.size(), 1u);
  EXPECT_EQ(read.effect("row_fault")->spells[0].reading, 0.5);
}

TEST(ConfinedEffect, RefusesTaxelsThatAreNotThere) {
  EXPECT_THROW(settings("  creep: {only_taxels: [6]}\n"), settings::InputError);
  EXPECT_THROW(settings("  creep: {only_surfaces: flat}\n"), settings::InputError);
  for (const char* spells : {"stuck_taxel: {spells: [6, 0, 1, 0]}", "dead_taxel: {spells: [1, 2, 1, 0]}",
                             "dead_taxel: {spells: [1, 0, 1]}", "creep: {spells: [1, 0, 1, 0]}",
                             "row_fault: {spells: [2, 0, 1, 0.5]}", "column_fault: {spells: [0, 0, 1, 2]}"})
    EXPECT_THROW(settings(std::string("  ") + spells + "\n"), settings::InputError) << spells;
}

}  // namespace
}  // namespace fsr::simulation
