// The hash of a prediction covers everything that confirm() uses and that the files beside it contain.

#include "discrepancy/prove/freeze.h"

#include <gtest/gtest.h>

#include <functional>

#include "planted.h"
#include "simulation/settings_text.h"
#include "simulation/taxel_curves.h"

namespace fsr::discrepancy {
namespace {

simulation::SimulationSettings base() {
  simulation::SimulationSettings base =
      planted::simulation(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.03, only_taxels: [1, 2]}\n");
  simulation::TaxelCurves curves;
  curves.taxels = 12;
  curves.surfaces = {{0, {0, 600e3}, std::vector<double>(24, 0.01)}};
  base.taxel_curves = std::make_shared<const simulation::TaxelCurves>(curves);
  base.taxel_curves_file = "base_curves.csv";
  return base;
}

Prediction prediction() {
  Prediction prediction{
      {{"creep", {{"amplitude", 0.01}}}}, {{{"time_skew", {{"delay", 0.2}}}}}, {0.6, 1.6}, ""};
  prediction.weights = {0.9, 0.1};
  prediction.spread = {{{0, "amplitude", false}}, {{1e-6}}, 24, 0.01, 3};
  return prediction;
}

struct Change {
  const char* what;
  std::function<void(Prediction&, simulation::SimulationSettings&)> make;
};

using P = Prediction;
using S = simulation::SimulationSettings;

const std::vector<Change> kChanges = {
    {"last digits of a value", [](P& p, S&) { p.effects[0].values["amplitude"] *= 1 + 1e-14; }},
    {"a taxel of an effect", [](P& p, S&) { p.effects[0].only_taxels = {3}; }},
    {"a surface of an effect", [](P& p, S&) { p.effects[0].only_surfaces = {"flat"}; }},
    {"a memory that begins anew", [](P& p, S&) { p.effects[0].carried_over = false; }},
    {"a rival", [](P& p, S&) { p.rivals.clear(); }},
    {"a rival's surface", [](P& p, S&) { p.rivals[0][0].only_surfaces = {"flat"}; }},
    {"the predicted size", [](P& p, S&) { p.size.high += 1e-12; }},
    {"a weight", [](P& p, S&) { p.weights[0] += 1e-12; }},
    {"the weights", [](P& p, S&) { p.weights.clear(); }},
    {"the covariance", [](P& p, S&) { p.spread.covariance[0][0] *= 4; }},
    {"the scale of a parameter", [](P& p, S&) { p.spread.parameters[0].logarithmic = true; }},
    {"the number of cycles", [](P& p, S&) { p.spread.cycles = 5; }},
    {"the scatter between groups", [](P& p, S&) { p.spread.between = 1; }},
    {"the whole distribution",
     [](P& p, S&) {
       p.weights.clear();
       p.spread = {};
     }},
    {"a value of the simulation", [](P&, S& s) { s.effects[0].values.begin()->second *= 1 + 1e-14; }},
    {"a taxel of the simulation's effect",
     [](P&, S& s) {
       for (auto& effect : s.effects)
         if (!effect.only_taxels.empty()) effect.only_taxels.pop_back();
     }},
    {"a taxel's curve",
     [](P&, S& s) {
       simulation::TaxelCurves curves = *s.taxel_curves;
       curves.surfaces[0].added[5] += 1e-9;
       s.taxel_curves = std::make_shared<const simulation::TaxelCurves>(curves);
     }},
    {"no curves of taxels", [](P&, S& s) { s.taxel_curves = nullptr; }},
    {"the climate", [](P&, S& s) { s.climate.heating = 1e-6; }},
    {"the seed", [](P&, S& s) { ++s.seed; }},
    {"the pitch", [](P&, S& s) { s.layout.pitch_x *= 2; }},
    {"the board", [](P&, S& s) { s.board.scan_rate *= 2; }},
    {"the transducer", [](P&, S& s) { s.transducer.high += 1; }},
    {"the session", [](P&, S& s) { s.session.pop_back(); }},
    {"a surface's curvature", [](P&, S& s) { s.session.back().surface.curvature[0].x *= 1.01; }},
};

TEST(PredictionHash, CoversThePredictionAndTheWholeSimulation) {
  const std::string hash = hashOf(prediction(), base());
  for (const Change& change : kChanges) {
    Prediction changed = prediction();
    simulation::SimulationSettings simulation = base();
    change.make(changed, simulation);
    EXPECT_NE(hashOf(changed, simulation), hash) << change.what;
    changed.hash = hash;
    EXPECT_FALSE(hasItsHash(changed, simulation)) << change.what;
  }
}

TEST(PredictionHash, TellsATaxelFromASurfaceThatIsCalledLikeIt) {
  Prediction taxel = prediction(), surface = prediction();
  taxel.effects[0].only_taxels = {3};
  surface.effects[0].only_surfaces = {"3"};
  EXPECT_NE(hashOf(taxel, base()), hashOf(surface, base()));
}

TEST(PredictionHash, StaysWhenTheSimulationIsWrittenReadAndRenamed) {
  simulation::SimulationSettings with = base();
  with.taxel_curves_file.clear();
  simulation::SimulationSettings read = simulation::readSimulation(
      settings::Settings::fromText(simulation::simulationText(with), "elsewhere.yaml"));
  read.taxel_curves = with.taxel_curves;
  read.taxel_curves_file = "renamed.csv";
  EXPECT_EQ(hashOf(prediction(), read), hashOf(prediction(), base()));
}

// printf 'creep{amplitude=0.01;}\ntime_skew{delay=0.2;}\n0.6 1.6\n3 x 4\nconverter{offset=2;}\n' | sha256sum
TEST(PredictionHash, AcceptsTheFirstFormOfOlderFiles) {
  simulation::SimulationSettings simulation = base();
  simulation.effects = {{"converter", {{"offset", 2}}}};
  EXPECT_EQ(firstHashOf(prediction(), simulation),
            "8e845e0efbe8cf6cc090c0f51384978d1f1edf43da7b0fe20075eb07947d818f");
  Prediction old = prediction();
  old.weights.clear();
  old.spread = {};
  old.hash = firstHashOf(old, base());
  EXPECT_TRUE(hasItsHash(old, base()));
  old.effects[0].values["amplitude"] *= 1.001;
  EXPECT_FALSE(hasItsHash(old, base()));
}

}  // namespace
}  // namespace fsr::discrepancy
