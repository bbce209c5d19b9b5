// What training learns of how the sheet rests, on a simulated rig: nothing is said against sound mounts, a
// surface that is declared wrongly is named, and what is missing is said in a sentence.

#include "calibration/stages/shape/learn_from_mounts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "calibration/merge.h"
#include "calibration/stages/shape/shape_check.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/settings_text.h"
#include "support/holds.h"
#include "support/simulated_rig.h"

namespace fsr::calibration {
namespace {

using Recordings = std::vector<dataset::Recording>;

// 4 x 5 taxels, each mounted anew for each bag.
struct MountedRig {
  std::vector<double> radii = {0, 0.20, 0.11, 0.07, 0.05};  // 0 = flat [m]
  int mounts = 3;                                           // of each surface
  double offset = 1e3;                                      // of a mount [Pa]
  double rest = 4;                                          // before each cycle [s]
  int rows = 4;
  unsigned seed = 1;
  unsigned sheet = 1;
};

std::string nameOf(double radius) {
  return radius == 0 ? "flat" : "cylinder_" + std::to_string(int(std::lround(100 * radius))) + "cm";
}

Recordings recordingsOf(const MountedRig& rig) {
  std::string session;
  for (int mount = 0; mount < rig.mounts; ++mount) {
    for (const double radius : rig.radii) {
      session += "  - {surface: " + nameOf(radius) + ", " +
                 (radius == 0 ? std::string("flat: true")
                              : "cylinder: {radius: " + std::to_string(radius) + ", axis: y}") +
                 "}\n";
    }
  }
  const std::string text = "simulation: sheet\nseed: " + std::to_string(rig.seed) +
                           "\nmatrix: {rows: " + std::to_string(rig.rows) +
                           ", columns: 5}\nboard: {scan_rate: 10}\nprogram:\n"
                           "  - cycles: {peak: 300000, rate: 60000, dwell_peak: 1, dwell_rest: " +
                           std::to_string(rig.rest) + ", cycles: 2}\nsession:\n" + session +
                           "effects:\n  static_curve: {conductance_scatter: 0.05, exponent_scatter: 0.03}\n"
                           "  bending_preload: {amplitude: 34000, curvature_constant: 3.0, scatter: 0.1}\n"
                           "  repositioning: {offset: " +
                           std::to_string(rig.offset) +
                           ", gain: 0.01}\n"
                           "  white_noise: {absolute: 3, relative: 0.001}\n"
                           "  converter: {full_scale: 4095, feedback_resistance: 3600}\n";
  return simulation::simulateSession(
      simulation::readSimulation(settings::Settings::fromText(text, "sheet.yaml")));
}

Calibration shapeTrained(Recordings recordings, const std::string& model = "monotone", unsigned threads = 0) {
  CalibrationProblem problem{std::move(recordings), {}};
  problem.options.threads = threads;
  problem.options.date = "2026-11-23T12:00:00Z";
  problem.options.scores = false;
  problem.options.regressor.name = model;
  problem.options.history = {false, HistoryFamily::kNone};
  problem.options.temperature = false;
  return calibrate(problem);
}

// Warnings about surfaces.
std::vector<std::string> complaints(const Calibration& calibration) {
  std::vector<std::string> found;
  for (const std::string& warning : calibration.warnings) {
    if (warning.find("the sheet rests as on") != std::string::npos) found.push_back(warning);
  }
  return found;
}

TEST(ShapeTraining, LearnsTheSurfacesAndSaysNothingAgainstSoundMounts) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    MountedRig rig;
    rig.seed = seed;
    const Calibration calibration = shapeTrained(recordingsOf(rig));
    const ShapeModel& shape = calibration.shape;
    ASSERT_TRUE(shape.present()) << shape.missing;
    EXPECT_EQ(shape.surfaces, (std::vector<std::string>{"flat", "cylinder_20cm", "cylinder_11cm",
                                                        "cylinder_7cm", "cylinder_5cm"}));
    EXPECT_EQ(shape.mounts, std::vector<std::uint32_t>(5, 3));
    EXPECT_EQ(shape.scatter.contrasts, 8u) << "readings on the flat are cut at 0";
    EXPECT_TRUE(shape.one_direction);
    EXPECT_NEAR(shape.direction.x, 1, 1e-9);
    EXPECT_EQ(std::count(shape.used.begin(), shape.used.end(), 1), 20);
    EXPECT_TRUE(complaints(calibration).empty()) << complaints(calibration).front();
  }
}

// The mount says which bag it is; the surface says what was meant to be below it.
void declare(Recordings& recordings, std::size_t bag, double radius) {
  matrix::Surface& surface = recordings[bag].conditions.front();
  surface.name = nameOf(radius);
  surface.curvature = {{radius == 0 ? 0 : 1 / radius, 0, 0}};
}

// One wrong mount widens the scatter that is learnt and draws the mean of its surface: the sound mounts there
// must not be blamed for it.
TEST(ShapeTraining, NamesTheBagWhoseSurfaceIsDeclaredWronglyAndNoOther) {
  struct Wrong {
    std::size_t bag;  // of the second mounts
    double declared;  // radius [m]
    const char* said;
  };
  for (const Wrong& wrong : {Wrong{5, 0.05, "its surface is 5.0 cm"}, Wrong{6, 0.05, "its surface is 5.0 cm"},
                             Wrong{9, 0.20, "its surface is 20.0 cm"}}) {
    Recordings recordings = recordingsOf({});
    declare(recordings, wrong.bag, wrong.declared);
    const std::vector<std::string> found = complaints(shapeTrained(recordings));
    ASSERT_EQ(found.size(), 1u) << "bag " << wrong.bag << (found.empty() ? "" : found[1]);
    EXPECT_EQ(found.front().find(recordings[wrong.bag].name + ", "), 0u) << found.front();
    EXPECT_NE(found.front().find(wrong.said), std::string::npos) << found.front();
  }
}

// Two wrong mounts: the second is found after the first was left out.
TEST(ShapeTraining, NamesTheSameBagsOnAnyNumberOfThreads) {
  MountedRig rig;
  rig.mounts = 4;
  Recordings recordings = recordingsOf(rig);
  declare(recordings, 5, 0.05);
  declare(recordings, 14, 0.20);
  const std::vector<std::string> one = complaints(shapeTrained(recordings, "monotone", 1));
  EXPECT_EQ(one.size(), 2u);
  EXPECT_EQ(complaints(shapeTrained(recordings, "monotone", 3)), one);
}

std::string missing(const Recordings& recordings) {
  return shapeTrained(recordings).shape.missing;
}

// Of the rest at its start, a second is under load.
void startLoaded(dataset::Recording& recording) {
  for (std::size_t i = 0; recording.time[i] < recording.time[0] + 1; ++i) recording.pressure[i] += 50e3;
}

TEST(ShapeTraining, SaysWhatIsMissing) {
  MountedRig two;
  two.radii = {0, 0.07};
  EXPECT_TRUE(
      test_support::holds(missing(recordingsOf(two)),
                          {"the bags hold a rest before the first load on 2 surfaces of one curvature"}));
  MountedRig once;
  once.mounts = 1;
  EXPECT_TRUE(test_support::holds(missing(recordingsOf(once)), {"the scatter between mounts is not known"}));
  MountedRig small;
  small.rows = 1;
  Recordings masked = recordingsOf(small);
  for (dataset::Recording& recording : masked) recording.mask = {0, 1, 0, 1, 0};
  EXPECT_EQ(missing(masked), "fewer than four taxels have a reading on every mount");
  Recordings loaded = recordingsOf({});
  for (dataset::Recording& recording : loaded) startLoaded(recording);
  EXPECT_EQ(missing(loaded).find("the bags hold a rest before the first load on 0 surfaces"), 0u);
}

// Five surfaces on two mounts each: five further mounts, of which three do not begin at rest.
TEST(ShapeTraining, SaysWhyMountsOfTheBagsDoNotCount) {
  MountedRig twice;
  twice.mounts = 2;
  Recordings recordings = recordingsOf(twice);
  for (const std::size_t bag : {5u, 6u, 7u}) startLoaded(recordings[bag]);
  const std::string sentence = missing(recordings);
  EXPECT_EQ(
      sentence.find("the scatter between mounts is not known: 2 further mounts of a surface can be used, "
                    "but three are needed; mount surfaces again; without a rest before the first load: " +
                    recordings[5].name + ", flat, mount "),
      0u)
      << sentence;
  EXPECT_NE(sentence.find("; " + recordings[7].name + ", cylinder_11cm, mount "), std::string::npos)
      << sentence;
}

// A surface whose curvature changes along the sheet belongs to none of the surfaces of one curvature, even
// where its first taxel has the curvature of one.
TEST(ShapeTraining, LeavesOutSurfacesWhoseCurvatureChangesAlongTheSheet) {
  Recordings recordings = recordingsOf({});
  for (const std::size_t bag : {3u, 8u, 13u}) {  // 7 cm
    matrix::Surface& surface = recordings[bag].conditions.front();
    surface.name = "cone";
    surface.curvature.assign(20, {1 / 0.07, 0, 0});
    for (std::size_t t = 0; t < 20; ++t) surface.curvature[t].x = 1 / 0.05 - 0.3 * double(t);
  }
  const Calibration calibration = shapeTrained(recordings);
  EXPECT_EQ(calibration.shape.surfaces.size(), 4u);
  EXPECT_TRUE(complaints(calibration).empty()) << complaints(calibration).front();
}

TEST(ShapeTraining, GivesTheSameForBagsInAnotherOrder) {
  Recordings recordings = recordingsOf({});
  const ShapeModel shape = shapeTrained(recordings).shape;
  std::reverse(recordings.begin(), recordings.end());
  const ShapeModel reversed = shapeTrained(recordings).shape;
  EXPECT_EQ(reversed.curvature, shape.curvature);
  ASSERT_EQ(reversed.rest.size(), shape.rest.size());
  for (std::size_t i = 0; i < shape.rest.size(); ++i) EXPECT_NEAR(reversed.rest[i], shape.rest[i], 1e-6);
  EXPECT_EQ(reversed.scatter.family, shape.scatter.family);
}

TEST(ShapeTraining, IsNotPossibleByMerging) {
  MountedRig rig;
  rig.radii = {0, 0.07};
  rig.mounts = 1;
  const Calibration calibration = shapeTrained(recordingsOf(rig), "linear");
  Calibration other = calibration;
  for (auto& bag : other.provenance.bags) std::reverse(bag.sha256.begin(), bag.sha256.end());
  const Calibration merged = mergeCalibrations({{"a.h5", calibration}, {"b.h5", other}}, {});
  EXPECT_TRUE(test_support::holds(merged.shape.missing, {"a merged calibration has no model of the shape"}));
}

// New mounts of the same sheet, and what is not a mount.
class CheckShapes : public testing::Test {
 protected:
  static const Calibration& calibration() {
    static const Calibration result = shapeTrained(recordingsOf({}));
    return result;
  }
  // Further mounts of the sheet of the calibration; the first 15 are those of training.
  static const Recordings& fresh() {
    static const Recordings result = [] {
      MountedRig rig;
      rig.mounts = 5;
      Recordings all = recordingsOf(rig);
      all.erase(all.begin(), all.begin() + 15);
      return all;
    }();
    return result;
  }
  // Readings at rest under a load that the chamber does not show [Pa], as far as the first scans tell it:
  // the readings of the scans at which the chamber is at that pressure.
  static RestReading under(const dataset::Recording& recording, double load, bool half) {
    const std::vector<std::size_t> rest = restAtStart(recording, 0);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (std::abs(recording.pressure[i] - load) < std::abs(recording.pressure[nearest] - load)) nearest = i;
    }
    RestReading reading = readingAtRest(recording, rest);
    const RestReading loaded = readingAtRest(recording, {nearest});
    for (std::size_t t = 0; t < reading.reading.size(); ++t) {
      if (!half || t % 5 < 3) reading.reading[t] = loaded.reading[t];
    }
    return reading;
  }
};

TEST_F(CheckShapes, AgreesWithSoundMounts) {
  const std::vector<CheckedMount> checked = checkShapes(calibration(), fresh());
  ASSERT_EQ(checked.size(), 10u);
  for (const auto& [mount, check] : checked) {
    EXPECT_EQ(check.verdict, ShapeVerdict::kAgrees) << mount.name << ": " << check.sentence;
    EXPECT_NE(std::find(check.possible.begin(), check.possible.end(), mount.surface.name),
              check.possible.end());
  }
}

TEST_F(CheckShapes, DisagreesWithASurfaceThatIsDeclaredWrongly) {
  Recordings recordings = fresh();
  declare(recordings, 0, 0.05);  // flat
  recordings.resize(1);
  const std::vector<CheckedMount> checked = checkShapes(calibration(), recordings);
  ASSERT_EQ(checked.size(), 1u);
  EXPECT_EQ(checked[0].check.verdict, ShapeVerdict::kDisagrees);
  EXPECT_TRUE(checked[0].check.estimated);
  EXPECT_EQ(checked[0].check.sentence.find("the sheet rests as on "), 0u) << checked[0].check.sentence;
  EXPECT_NE(checked[0].check.sentence.find(", but the surface file says cylinder_5cm (5.0 cm)"),
            std::string::npos)
      << checked[0].check.sentence;
}

TEST_F(CheckShapes, RefusesARecordingOfAnotherMatrix) {
  MountedRig small;
  small.rows = 3;
  small.mounts = 1;
  try {
    checkShapes(calibration(), recordingsOf(small));
    FAIL();
  } catch (const settings::InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("has 3 x 5 taxels up to 4095 counts, but the calibration is for 4 x 5 up to 4095"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(CheckShapes, AbstainsUnderALoad) {
  for (const dataset::Recording& recording : fresh()) {
    for (const bool half : {false, true}) {
      const matrix::Surface& declared = recording.conditions.front();
      const ShapeCheck check = checkShape(calibration().shape, under(recording, 40e3, half), declared);
      EXPECT_EQ(check.verdict, ShapeVerdict::kUnknown)
          << recording.name << (half ? " half: " : ": ") << check.sentence;
      EXPECT_FALSE(check.estimated);
    }
  }
}

// A strap over a part of the sheet: whatever it presses with, no surface is blamed for it.
TEST_F(CheckShapes, BlamesNoSurfaceForALoadOnHalfTheSheet) {
  std::size_t abstained = 0;
  for (const dataset::Recording& recording : fresh()) {
    for (const double load : {10e3, 20e3, 30e3}) {
      const matrix::Surface& declared = recording.conditions.front();
      const ShapeCheck check = checkShape(calibration().shape, under(recording, load, true), declared);
      EXPECT_NE(check.verdict, ShapeVerdict::kDisagrees)
          << recording.name << ", " << load << " Pa: " << check.sentence;
      if (check.verdict != ShapeVerdict::kUnknown) continue;
      ++abstained;
      EXPECT_FALSE(check.estimated);
      EXPECT_NE(check.sentence.find(check.changes ? "and so would a load on a part of the sheet"
                                                  : "a load or a strap, another temperature"),
                std::string::npos)
          << check.sentence;
    }
  }
  EXPECT_GT(abstained, 5u);
}

TEST_F(CheckShapes, AbstainsOnAnotherSheet) {
  MountedRig other;
  other.seed = 9;
  other.mounts = 1;
  for (const dataset::Recording& recording : recordingsOf(other)) {
    const RestReading rest = readingAtRest(recording, restAtStart(recording, 0));
    const ShapeCheck check = checkShape(calibration().shape, rest, recording.conditions.front());
    EXPECT_NE(check.verdict, ShapeVerdict::kDisagrees) << recording.name << ": " << check.sentence;
    if (recording.conditions.front().name == "flat") continue;  // all sheets are alike where nothing presses
    EXPECT_EQ(check.verdict, ShapeVerdict::kUnknown) << recording.name << ": " << check.sentence;
  }
}

TEST_F(CheckShapes, ComparesNothingAtAnotherTemperature) {
  Recordings recordings = fresh();
  recordings.resize(2);
  for (double& celsius : recordings[0].temperature) celsius += 4;
  for (double& celsius : recordings[1].temperature) celsius += 6;
  const std::vector<CheckedMount> checked = checkShapes(calibration(), recordings);
  ASSERT_EQ(checked.size(), 2u);
  EXPECT_EQ(checked[0].check.verdict, ShapeVerdict::kAgrees) << checked[0].check.sentence;
  EXPECT_EQ(checked[1].check.verdict, ShapeVerdict::kUnknown);
  EXPECT_TRUE(test_support::holds(checked[1].check.sentence, {"29.0 degrees", "23.0 to 23.0"}));
}

TEST_F(CheckShapes, ComparesNothingOnAnotherBoard) {
  Recordings recordings = fresh();
  recordings.resize(1);
  recordings[0].sensor.serial = "SIM-0002";
  const std::vector<CheckedMount> checked = checkShapes(calibration(), recordings);
  ASSERT_EQ(checked.size(), 1u);
  EXPECT_TRUE(test_support::holds(checked[0].check.sentence, {"board is SIM-0002", "SIM-0001"}));
}

TEST(TemperatureObstacle, IsNoneWhereATemperatureIsNotKnown) {
  EXPECT_EQ(temperatureObstacle(NAN, 20, 25), "");
  EXPECT_EQ(temperatureObstacle(60, NAN, NAN), "");
  EXPECT_EQ(temperatureObstacle(15.1, 20, 25), "");
  EXPECT_NE(temperatureObstacle(14.9, 20, 25), "");
}

TEST_F(CheckShapes, SaysWhyThereIsNoModel) {
  ShapeModel none;
  none.missing = "no bag starts with a rest";
  const ShapeCheck check = checkShape(none, {}, {});
  EXPECT_EQ(check.verdict, ShapeVerdict::kUnknown);
  EXPECT_EQ(check.sentence, "how the sheet lies cannot be told: no bag starts with a rest");
}

TEST_F(CheckShapes, SaysHowManyTaxelsAreMissing) {
  RestReading rest = readingAtRest(fresh()[0], restAtStart(fresh()[0], 0));
  std::fill(rest.reading.begin(), rest.reading.begin() + 11, NAN);
  EXPECT_TRUE(
      test_support::holds(checkShape(calibration().shape, rest, fresh()[0].conditions.front()).sentence,
                          {"cannot be told", "9 of 20 taxels"}));
}

// An estimate is used only where its interval is at most half of the training, 10 of 20 1/m.
TEST_F(CheckShapes, EstimatesWhereNoSurfaceIsDeclared) {
  std::size_t told = 0;
  for (const dataset::Recording& recording : fresh()) {
    const ShapeCheck check =
        checkShape(calibration().shape, readingAtRest(recording, restAtStart(recording, 0)), {});
    EXPECT_EQ(check.verdict, ShapeVerdict::kUnknown);
    EXPECT_EQ(check.estimated, check.estimate.high - check.estimate.low <= 10) << check.sentence;
    const char* const said =
        check.estimated ? "; no surface is declared" : "how the sheet lies cannot be told: ";
    EXPECT_NE(check.sentence.find(said), std::string::npos) << check.sentence;
    if (!check.estimated) continue;
    ++told;
    const double curvature = matrix::principalCurvature(recording.conditions.front().curvature.front());
    EXPECT_NEAR(check.estimate.curvature, curvature, 4 * check.estimate.deviation + 0.5) << recording.name;
  }
  EXPECT_GT(told, 0u);
}

TEST(BendText, IsARadius) {
  EXPECT_EQ(bendText(0.2), "flat");
  EXPECT_EQ(bendText(20), "5.0 cm");
  EXPECT_EQ(bendText(-12.5), "concave, 8.0 cm");
}

}  // namespace
}  // namespace fsr::calibration
