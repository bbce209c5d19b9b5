#include "fsr_pressure_map/simulation/simulation_settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "settings/text.h"
#include "simulation/effects/effect_library.h"
#include "simulation/pressure_profile.h"
#include "simulation/sensor_chain.h"
#include "simulation/settings_text.h"
#include "support/holds.h"
#include "support/source_dir.h"

namespace {

using fsr::settings::InputError;
using fsr::settings::Settings;
using fsr::simulation::readSimulation;
using test_support::holds;

const std::filesystem::path kFolder = test_support::sourceDir() + "/config/simulation";

std::string complaintAbout(const std::string& yaml) {
  return test_support::refusal(
      [&] { fsr::simulation::SensorChain chain(readSimulation(Settings::fromText(yaml, "my.yaml"))); },
      "none");
}

std::string withEffects(const std::string& effects) {
  return "{simulation: a, effects: {static_curve: {}, converter: {}, " + effects + "}}";
}

TEST(SimulationSettings, EveryShippedFileIsReadAndRuns) {
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
    const auto settings = fsr::simulation::readSimulationFile(file.path());
    EXPECT_EQ(settings.name, file.path().stem()) << "the name inside is the file's";
    fsr::simulation::SensorChain chain(settings);
    const fsr::simulation::PressureCourse course = [](double) { return 100e3; };
    EXPECT_EQ(chain.read({0, 100e3, 0, 23, &course}).size(), settings.layout.size.taxels());
    for (const auto& station : settings.session)
      EXPECT_TRUE(std::isfinite(pressureProfile(station.program).duration()));
    ++files;
  }
  EXPECT_GE(files, 7);
}

TEST(SimulationSettings, WrittenOutAndReadBackTheyAreTheSame) {
  for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
    const auto settings = fsr::simulation::readSimulationFile(file.path());
    const std::string text = simulationText(settings, "what it is\nand why");
    const auto again = readSimulation(Settings::fromText(text, "again.yaml"));
    EXPECT_EQ(simulationText(again, "what it is\nand why"), text);
    EXPECT_EQ(again.seed, settings.seed);
    EXPECT_EQ(again.session.size(), settings.session.size());
    fsr::simulation::SensorChain before(settings), after(again);
    before.mount(settings.session.back().surface);
    after.mount(again.session.back().surface);
    const fsr::simulation::PressureCourse course = [](double time) { return 5e3 * time; };
    for (std::uint64_t i = 0; i < 100; ++i) {
      const fsr::simulation::RigSample sample{double(i), 5e3 * double(i), i, 23, &course};
      EXPECT_EQ(before.read(sample), after.read(sample));
    }
  }
}

TEST(SimulationSettings, WrittenOutTheyKeepEveryFormOfSurfaceLoadAndProgram) {
  const auto settings = readSimulation(Settings::fromText(
      R"({simulation: 'a "strange" \ name', seed: 8999999999999999, matrix: {rows: 1, columns: 3},
          board: {scan_rate: 33.3, scan_duration: 0.001}, start: 1704099600.25,
          program: [{loops: {low: 1e5, high: 2e5, rate: 17e3, loops: 2}}, {rest: {duration: 7}}],
          session: [{surface: bumpy, taxels: {x: [1.5, -2, 3], y: [0, 0.1, 0], xy: [0, 0, 1]}, pause: 0},
                    {surface: flat, flat: true, load: {disc: {x: 0.01, y: 0, radius: 0.005}}},
                    {surface: flat, flat: true, load: {edge: {x: 0, y: 0, angle: 0.3}},
                     program: [{hold: {pressure: 1e5, rate: 1e4, duration: 0.1}}, {cycles: {cycles: 2}}]}],
          climate: {room: [{time: 0, temperature: 20}, {time: 60, temperature: 21.5}], heating: 1e-5},
          transducer: {low: 0, high: 1e6, full_counts: 1000},
          effects: {static_curve: {}, converter: {}, creep: {per_decade: 0.012}}})",
      "a.yaml"));
  const std::string text = simulationText(settings);
  const auto again = readSimulation(Settings::fromText(text, "again.yaml"));
  EXPECT_EQ(simulationText(again), text);
  EXPECT_EQ(again.name, "a \"strange\" \\ name");
  EXPECT_EQ(again.seed, 8999999999999999u);
  EXPECT_EQ(again.session[0].surface.curvature[1].y, 0.1);
  EXPECT_EQ(again.session[2].load.kind, fsr::simulation::LoadPattern::Kind::kEdge);
  EXPECT_EQ(pressureProfile(again.session[2].program).at(5),
            pressureProfile(settings.session[2].program).at(5));
  EXPECT_EQ(again.climate.room[1].temperature, 21.5);
}

TEST(SimulationSettings, WrittenOutTheySayUnitsMeaningsAndWhereAValueComesFrom) {
  const auto settings = fsr::simulation::readSimulationFile(kFolder / "bench.yaml");
  const std::string text = simulationText(settings, "Fitted.", {{"hysteresis.span", "95 %: 6 to\n7"}});
  EXPECT_EQ(text.find("# Fitted.\n"), 0u);
  EXPECT_TRUE(
      holds(text, {"    span: 620000  # [Pa] pressure that loop_width is a share of; 95 %: 6 to 7\n"}));
}

TEST(SimulationSettings, CoreHoldsWhatEveryMatrixHasAndNothingElse) {
  std::vector<std::string> ids;
  for (const auto& effect : fsr::simulation::readSimulationFile(kFolder / "core.yaml").effects)
    ids.push_back(effect.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"bending_preload", "bending_gain", "static_curve", "converter",
                                           "white_noise"}));
}

TEST(SimulationSettings, TheBenchmarksRigHasEveryEffect) {
  const auto settings =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/test/benchmark/all_effects.yaml");
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    EXPECT_EQ(settings.effect(entry.info.id) != nullptr, entry.make != nullptr) << entry.info.id;
  }
}

TEST(SimulationSettings, MissingPartsHaveTheirDefaults) {
  const auto settings = readSimulation(Settings::fromText(withEffects("hysteresis: {}"), "my.yaml"));
  EXPECT_EQ(settings.layout.size, (fsr::matrix::MatrixSize{7, 10}));
  EXPECT_EQ(settings.chamber.peak, 620e3);
  EXPECT_EQ(settings.fullScale(), 4095);
  EXPECT_EQ(settings.effect("hysteresis")->values.at("loop_width"), 0.05);
  EXPECT_EQ(settings.effect("white_noise"), nullptr);
}

TEST(SimulationSettings, UnknownEffectsAndKeysAreRefusedByName) {
  const std::string complaint = complaintAbout(withEffects("hysterese: {}"));
  EXPECT_EQ(
      complaint.find("my.yaml: effects.hysterese is a mapping, but no effect has that name; the effects are "
                     "time_skew, scan_skew, "),
      0u);
  EXPECT_TRUE(
      holds(complaintAbout(withEffects("clock_rate: {rate: 1e-4}")), {"time_skew: {delay: 0, rate: "}));
  EXPECT_TRUE(holds(complaintAbout(withEffects("hysteresis: {width: 0.05}")), {"effects.hysteresis.width"}));
  EXPECT_TRUE(
      holds(complaintAbout("{simulation: a, effects: {static_curve: {}, converter: {}}, chambre: {}}"),
            {"chambre"}));
}

std::map<std::string, fsr::settings::Range> rangesOf(const fsr::simulation::EffectEntry& entry) {
  std::map<std::string, fsr::settings::Range> ranges;
  for (const auto& parameter : entry.info.parameters) ranges[parameter.name] = parameter.permitted;
  return ranges;
}

std::string withSession(const std::string& station) {
  return "{simulation: a, session: [{surface: s, " + station +
         "}], effects: {static_curve: {}, converter: {}}}";
}

TEST(SimulationSettings, WhatARigCannotDoIsRefusedByName) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {withEffects("hysteresis: {}, hysteresis: {}"), "effects.hysteresis is given twice"},
      {withSession("cylinder: {radius: 0.009, axis: y}"), "session[0].cylinder.radius is 0.009"},
      {withSession("two_planes: {x: 101, y: 0}"), "session[0].two_planes.x is 101"},
      {withSession("flat: true, pauze: 5"), "session[0].pauze is not a known setting"},
      {withSession("flat: true, load: {disc: {radius: 0}}"), "session[0].load.disc.radius is 0"},
      {withSession("flat: true, load: {}"), "give exactly one of disc and edge"},
      {withSession("flat: true, program: [{hold: {pressure: 794e3, duration: 1}}]"),
       "session[0].program[0].hold.pressure is 794e3"},
      {"{simulation: a, matrix: {rows: 0}, effects: {static_curve: {}, converter: {}}}", "matrix.rows is 0"},
      {"{simulation: a, session: [], effects: {static_curve: {}, converter: {}}}",
       "must contain at least one surface"},
      {withEffects("humidity: {}"), "it cannot be simulated: a gas chamber cannot show it"},
      {"{simulation: a, effects: {converter: {}}}", "effects.static_curve is missing"},
      {"{simulation: a, board: {scan_rate: 100, scan_duration: 0.02}, effects: {static_curve: {}, converter: "
       "{}}}",
       "board.scan_duration"},
      {"{simulation: a, chamber: {peak: 800e3}, effects: {static_curve: {}, converter: {}}}", "793"},
  };
  for (const auto& [yaml, expected] : cases) {
    const std::string complaint = complaintAbout(yaml);
    EXPECT_EQ(complaint.find("my.yaml: "), 0u) << complaint;
    EXPECT_NE(complaint.find(expected), std::string::npos) << complaint;
  }
}

/// An effects section with this one of it.
std::string oneEffect(const std::string& id, const std::string& values) {
  std::string others;
  for (const char* required : {"static_curve", "converter"}) {
    if (id != required) others += std::string(required) + ": {}, ";
  }
  return "{simulation: a, effects: {" + others + id + ": {" + values + "}}}";
}

void expectRefused(const std::string& yaml, const std::string& field) {
  const std::string complaint = complaintAbout(yaml);
  EXPECT_EQ(complaint.find("my.yaml: " + field + " is "), 0u) << complaint << " instead of " << field;
}

TEST(SimulationSettings, EveryParameterOfEveryEffectIsRefusedByNameOutsideItsRange) {
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    if (!entry.make) continue;
    const std::string& id = entry.info.id;
    expectRefused(oneEffect(id, "bogus: 1"), "effects." + id + ".bogus");
    for (const auto& [name, range] : rangesOf(entry)) {
      const std::string field = "effects." + id + "." + name;
      expectRefused(oneEffect(id, name + ": .nan"), field);
      expectRefused(oneEffect(id, name + ": much"), field);
      if (std::isfinite(range.low)) {
        expectRefused(
            oneEffect(id, name + ": " + fsr::settings::numberText(range.low - 1 - std::abs(range.low))),
            field);
      }
      if (std::isfinite(range.high)) {
        expectRefused(
            oneEffect(id, name + ": " + fsr::settings::numberText(range.high + 1 + std::abs(range.high))),
            field);
      }
    }
  }
}

}  // namespace
