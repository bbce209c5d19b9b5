#include "calibration/stages/deviation/new_mount_line.h"

#include <gtest/gtest.h>

#include "support/mounted_day.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

dataset::Recording mounted(std::uint32_t mount, double gain) {
  test_support::SyntheticRig rig;
  rig.surfaces = {{"cylinder_6cm", 16.7}};
  rig.cycles = 6;
  rig.seed = mount;
  dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.name = "mount_" + std::to_string(mount) + ".bag";
  for (matrix::Surface& surface : recording.conditions) surface.mount = mount;
  for (std::uint16_t& count : recording.counts) count = static_cast<std::uint16_t>(gain * count);
  return recording;
}

Calibration trainedOn(const std::vector<double>& gains, unsigned threads = 2) {
  CalibrationProblem problem;
  for (std::size_t i = 0; i < gains.size(); ++i)
    problem.recordings.push_back(mounted(static_cast<std::uint32_t>(i + 1), gains[i]));
  problem.options.choose_bandwidth = false;
  problem.options.threads = threads;
  return calibrate(problem);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(NewMountLine, NamesTheMountThatIsNotLikeTheOthers) {
  const std::string note = newMountNote(trainedOn({1, 1.02, 0.99, 0.85, 1.01}).budget);
  EXPECT_TRUE(has(note, "on a new mount of a known surface 68 % of the readings err by at most ")) << note;
  EXPECT_TRUE(has(note, "; worst of 5 mounts: mount_4.bag, cylinder_6cm, mount 4, RMSE ")) << note;
  EXPECT_TRUE(has(note, "; next: see whether that mount was as declared")) << note;
}

TEST(NewMountLine, TheFirstWarningNamesMountsThatDifferAlsoWhereEitherMayBeWrong) {
  for (const bool wrong : {true, false}) {
    CalibrationProblem problem{test_support::recorded({"bench", 2, wrong}), {}};
    problem.options.choose_bandwidth = false;
    problem.options.history = {false, HistoryFamily::kNone};
    const Calibration calibration = calibrate(problem);
    const std::string first = calibration.warnings.empty() ? "" : calibration.warnings.front();
    EXPECT_EQ(has(first, "cylinder_10cm: mount 1 (1_cylinder_10cm.bag) and mount 5 "), wrong) << first;
    EXPECT_EQ(has(first, "two mounts, either may be wrong"), wrong) << first;
  }
}

TEST(NewMountLine, NamesTheWorstMountWithoutAVerdictWhereAllAreAlike) {
  const std::string note = newMountNote(trainedOn({1, 1.02, 0.99, 1.01}).budget);
  EXPECT_TRUE(has(note, "; worst of 4 mounts: ")) << note;
  EXPECT_FALSE(has(note, "was as declared")) << note;
}

TEST(NewMountLine, IsTheSameOnAnyNumberOfThreads) {
  EXPECT_EQ(newMountNote(trainedOn({1, 1.02, 0.99}, 1).budget),
            newMountNote(trainedOn({1, 1.02, 0.99}, 3).budget));
}

TEST(NewMountLine, SaysWhatOneMountDoesNotTell) {
  const std::string note = newMountNote(trainedOn({1}).budget);
  EXPECT_EQ(note.find("not known on a new mount, because no surface was mounted more than once; 95 % of the "
                      "readings of new cycles on the same mounts err by at most "),
            0u)
      << note;
  EXPECT_TRUE(has(note, "; worst surface: cylinder_6cm, RMSE ")) << note;
  EXPECT_TRUE(has(note, "; next: record each surface on two mounts or more")) << note;
}

// Errors of 6.2 kPa are 1.0 % of 0 to 620 kPa.
TEST(NewMountLine, StatesErrorsInKilopascalAndPercentOfTheRange) {
  EXPECT_EQ(errorText(6.2e3, {0, 620e3}), "6.2 kPa (1.0 % of the range)");
  EXPECT_EQ(errorText(6.2e3, {}), "6.2 kPa (- of the range)");
}

}  // namespace
}  // namespace fsr::calibration
