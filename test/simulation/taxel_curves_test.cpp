#include "simulation/taxel_curves.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"
#include "simulation/sensor_chain.h"
#include "simulation/settings_text.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/source_dir.h"

namespace fsr::simulation {
namespace {

namespace fs = std::filesystem;

class TaxelCurvesFile : public test_support::FolderTest {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  std::string complaint(const std::string& text) const {
    return test_support::refusal([&] { readTaxelCurves(write("bad.csv", text)); });
  }
};

// 1 x 2 taxels, flat and bent.
TaxelCurves example() {
  return {{{0, {0, 100e3}, {0.0, 0.01, 0.02, 0.03}}, {14.25, {50e3}, {-0.01, 1.0 / 3}}}, 2};
}

SimulationSettings smallRig() {
  SimulationSettings settings =
      readSimulationFile(test_support::sourceDir() + "/config/simulation/core.yaml");
  settings.layout.size = {1, 2};
  return settings;
}

// Hand-made: the natural cubic spline through (0, 0), (1, 1), (2, 0) has the second derivative -3 at 1.
TEST(TaxelCurves, AreNaturalCubicSplinesWithStraightEnds) {
  const LoadCurves curves({0, {0, 1, 2}, {0, 1, 0}}, 1);
  EXPECT_DOUBLE_EQ(curves.at(0, 0), 0);
  EXPECT_DOUBLE_EQ(curves.at(0, 1), 1);
  EXPECT_DOUBLE_EQ(curves.at(0, 0.5), 0.6875);  // 1.5 x - 0.5 x^3
  EXPECT_DOUBLE_EQ(curves.at(0, 1.5), 0.6875);
  EXPECT_DOUBLE_EQ(curves.at(0, -1), -1.5);
  EXPECT_DOUBLE_EQ(curves.at(0, 4), -3);
  EXPECT_EQ(LoadCurves({0, {5}, {0.25}}, 1).at(0, 100), 0.25) << "one load";
}

TEST(TaxelCurves, OfTheNearestCurvatureAreTaken) {
  EXPECT_EQ(example().nearestIndex(0.5), 0u);
  EXPECT_EQ(example().nearestIndex(20), 1u);
}

TEST(TaxelCurves, AddToWhatTheChainReads) {
  SimulationSettings settings = withoutNoise(smallRig());
  SensorChain plain(settings);
  settings.taxel_curves = std::make_shared<const TaxelCurves>(example());
  SensorChain corrected(settings);
  RigSample sample;
  sample.pressure = 50e3;
  plain.read(sample);
  corrected.read(sample);
  EXPECT_NEAR(corrected.reading()[0] - plain.reading()[0], 4095 * 0.01, 1e-9);
  EXPECT_NEAR(corrected.reading()[1] - plain.reading()[1], 4095 * 0.02, 1e-9);
  corrected.mount(matrix::Surface{"bent", 1, {matrix::Curvature{13, 0, 0}}, {}});
  plain.mount(matrix::Surface{"bent", 1, {matrix::Curvature{13, 0, 0}}, {}});
  sample.time = 1;
  plain.read(sample);
  corrected.read(sample);
  // Bending changes the gain, and the deviations with it.
  const double gain = plain.signals().gain[1];
  EXPECT_LT(gain, 1);
  EXPECT_NEAR(corrected.reading()[1] - plain.reading()[1], gain * 4095 / 3.0, 1e-9);
}

TEST(TaxelCurves, RefuseAnotherMatrix) {
  SimulationSettings settings = smallRig();
  settings.layout.size = {2, 2};
  settings.taxel_curves = std::make_shared<const TaxelCurves>(example());
  EXPECT_THROW(SensorChain chain(settings), settings::InputError);
}

TEST_F(TaxelCurvesFile, KeepsEveryBitBesideItsSimulation) {
  write("curves.csv", taxelCurvesText(example()));
  SimulationSettings settings = smallRig();
  settings.taxel_curves_file = "curves.csv";
  const SimulationSettings read = readSimulationFile(write("rig.yaml", simulationText(settings)));
  ASSERT_TRUE(read.taxel_curves);
  EXPECT_EQ(read.taxel_curves_file, "curves.csv");
  EXPECT_EQ(read.taxel_curves->taxels, 2u);
  ASSERT_EQ(read.taxel_curves->surfaces.size(), 2u);
  EXPECT_EQ(read.taxel_curves->surfaces[0].load, example().surfaces[0].load);
  EXPECT_EQ(read.taxel_curves->surfaces[1].added, example().surfaces[1].added);
}

TEST_F(TaxelCurvesFile, IsRefusedByLineAndColumn) {
  const std::string head = "curvature_per_m,load_Pa,taxel_0\n";
  EXPECT_NE(complaint(head + "0,0,0\n0,0,1\n").find("line 3, column load_Pa"), std::string::npos);
  EXPECT_NE(complaint(head + "0,0,x\n").find("line 2, column taxel_0"), std::string::npos);
  EXPECT_NE(complaint(head).find("no row"), std::string::npos);
  EXPECT_NE(complaint("a,b\n0,0\n").find("no column for a taxel"), std::string::npos);
}

}  // namespace
}  // namespace fsr::simulation
