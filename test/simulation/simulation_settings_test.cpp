#include "fsr_pressure_map/simulation/simulation_settings.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "fsr_pressure_map/simulation/sensor_chain.h"

namespace {

using fsr::InputError;
using fsr::readSimulation;
using fsr::Settings;

const std::filesystem::path kFolder = FSR_SOURCE_DIR "/config/simulation";

std::string complaintAbout(const std::string& yaml) {
  try {
    fsr::SensorChain chain(readSimulation(Settings::fromText(yaml, "my.yaml")));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

std::string withEffects(const std::string& effects) {
  return "{simulation: a, effects: {static_curve: {}, converter: {}, " + effects + "}}";
}

TEST(SimulationSettings, EveryShippedFileIsReadAndRuns) {
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
    const auto settings = fsr::readSimulationFile(file.path());
    EXPECT_EQ(settings.name, file.path().stem()) << "the name inside is the file's";
    fsr::SensorChain chain(settings);
    EXPECT_EQ(chain.read({0, 100e3, 0}).size(), settings.layout.size.taxels());
    ++files;
  }
  EXPECT_GE(files, 4);
}

TEST(SimulationSettings, CoreHoldsWhatEveryMatrixHasAndNothingElse) {
  std::vector<std::string> ids;
  for (const auto& effect : fsr::readSimulationFile(kFolder / "core.yaml").effects) ids.push_back(effect.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"bending_preload", "bending_gain", "static_curve", "converter",
                                           "white_noise"}));
}

TEST(SimulationSettings, MissingPartsHaveTheirDefaults) {
  const auto settings = readSimulation(Settings::fromText(withEffects("hysteresis: {}"), "my.yaml"));
  EXPECT_EQ(settings.layout.size, (fsr::MatrixSize{7, 10}));
  EXPECT_EQ(settings.chamber.peak, 620e3);
  EXPECT_EQ(settings.fullScale(), 4095);
  EXPECT_EQ(settings.effect("hysteresis")->values.at("loop_width"), 0.05);
  EXPECT_EQ(settings.effect("white_noise"), nullptr);
}

TEST(SimulationSettings, UnknownEffectsAndKeysAreRefusedByName) {
  EXPECT_EQ(complaintAbout(withEffects("hysterese: {}")),
            "my.yaml: effects.hysterese is a mapping, but no effect has that name; the effects are "
            "bending_preload, hysteresis, bending_gain, static_curve, converter, white_noise");
  EXPECT_NE(complaintAbout(withEffects("hysteresis: {width: 0.05}")).find("effects.hysteresis.width"),
            std::string::npos);
  EXPECT_NE(complaintAbout("{simulation: a, effects: {static_curve: {}, converter: {}}, chambre: {}}")
                .find("chambre"),
            std::string::npos);
  EXPECT_NE(complaintAbout(withEffects("hysteresis: {}, hysteresis: {}")).find("given twice"),
            std::string::npos);
}

TEST(SimulationSettings, ValuesOutOfRangeAreRefusedByName) {
  EXPECT_EQ(complaintAbout(withEffects("hysteresis: {loop_width: -0.1}")),
            "my.yaml: effects.hysteresis.loop_width is -0.1, but must be a number, 0 to 0.5");
  EXPECT_NE(complaintAbout("{simulation: a, matrix: {rows: 0}, effects: {static_curve: {}, converter: {}}}")
                .find("matrix.rows is 0"),
            std::string::npos);
  EXPECT_NE(
      complaintAbout("{simulation: a, chamber: {peak: 800e3}, effects: {static_curve: {}, converter: {}}}")
          .find("793"),
      std::string::npos);
}

TEST(SimulationSettings, ASensorNeedsItsStaticCurveAndConverter) {
  EXPECT_NE(
      complaintAbout("{simulation: a, effects: {converter: {}}}").find("effects.static_curve is missing"),
      std::string::npos);
}

TEST(SimulationSettings, AScanMustFitBetweenTwoScans) {
  EXPECT_NE(complaintAbout("{simulation: a, board: {scan_rate: 100, scan_duration: 0.02}, "
                           "effects: {static_curve: {}, converter: {}}}")
                .find("board.scan_duration"),
            std::string::npos);
}

}  // namespace
