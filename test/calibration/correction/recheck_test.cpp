#include "calibration/correction/recheck.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "calibration/merge.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"

namespace {

using fsr::calibration::Calibration;
using fsr::calibration::ChangeModel;
using fsr::calibration::Recheck;
using fsr::calibration::RecheckVerdict;
using fsr::dataset::Recording;
using test_support::SyntheticRig;

// Reading of today for a reading of before; taxel.
using Change = std::function<double(double reading, std::size_t taxel)>;

// The sheet has a loop, as real ones do: without one the smallest change would be worth a correction.
SyntheticRig rig(unsigned seed, bool bent = true) {
  SyntheticRig result;
  result.name = "sheet_" + std::to_string(seed) + ".bag";
  result.surfaces = {{"flat", 0.0}};
  if (bent) result.surfaces.push_back({"cylinder_7cm", 14.25});
  result.loop = 60;
  result.noise = 20;
  result.seed = seed;
  return result;
}

Recording changed(Recording recording, const Change& change) {
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.counts.size(); ++i) {
    const double reading = change(recording.counts[i], i % taxels);
    recording.counts[i] = static_cast<std::uint16_t>(std::lround(std::min(std::max(reading, 0.0), 4095.0)));
  }
  return recording;
}

Calibration trainedOn(const Recording& recording) {
  fsr::calibration::CalibrationProblem problem;
  problem.recordings = {recording};
  problem.options.scores = false;
  problem.options.history = {false, fsr::compensation::HistoryFamily::kNone};
  problem.options.choose_bandwidth = false;
  Calibration calibration = fsr::calibration::calibrate(problem);
  calibration.id = "0123456789ab";
  return calibration;
}

const Calibration& parent() {
  static const Calibration instance = trainedOn(syntheticRecording(rig(1)));
  return instance;
}

// The sheet was not taken out since the training.
fsr::calibration::RecheckOptions sameMount() {
  fsr::calibration::RecheckOptions options;
  options.same_mount = true;
  return options;
}

Recheck recheck(const Change& change, unsigned seed = 2, bool bent = false) {
  return fsr::calibration::recheckCalibration(
      parent(), {changed(syntheticRecording(rig(seed, bent)), change)}, sameMount());
}

// One bag, one file, one expected error.
TEST(Recheck, StatesTheExpectedErrorOfTrainCheck) {
  const std::vector<Recording> recordings = {syntheticRecording(rig(2, false))};
  const double checked = fsr::calibration::checkCalibration(parent(), recordings).whole.expected_rmse;
  EXPECT_DOUBLE_EQ(fsr::calibration::recheckCalibration(parent(), recordings, sameMount()).expected, checked);
  const Change worn = [](double reading, std::size_t) { return 0.9 * reading + 30; };
  const std::vector<Recording> other = {changed(recordings.front(), worn)};
  const Recheck corrected = fsr::calibration::recheckCalibration(parent(), other, sameMount());
  ASSERT_EQ(corrected.verdict, RecheckVerdict::kCorrected);
  EXPECT_DOUBLE_EQ(corrected.expected,
                   fsr::calibration::checkCalibration(parent(), other).whole.expected_rmse);
}

// Flat on mounts that read `gains` as much; numbers 2, 3, ...
std::vector<Recording> mounts(const std::vector<double>& gains, const Change& change) {
  std::vector<Recording> recordings;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const double gain = gains[i];
    const auto mounted = [&](double reading, std::size_t taxel) { return gain * change(reading, taxel); };
    recordings.push_back(changed(syntheticRecording(rig(20 + unsigned(i), false)), mounted));
    recordings.back().conditions[0].mount = std::uint32_t(2 + i);
  }
  return recordings;
}

// Verdict, reasons and remarks, one a line.
std::string said(const Recheck& result) {
  std::string text = verdictName(result.verdict);
  for (const std::string& reason : result.reasons) text += '\n' + reason;
  for (const std::string& remark : result.remarks) text += '\n' + remark;
  return text;
}

double unchanged(double reading, std::size_t) {
  return reading;
}
double worn(double reading, std::size_t) {
  return 0.95 * reading + 25;
}

double rmse(const Calibration& calibration, const Recording& recording) {
  return fsr::calibration::checkCalibration(calibration, {recording}).whole.rmse;
}

template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const fsr::settings::InputError& error) {
    return error.what();
  }
  return "";
}

std::string refusalOf(const Calibration& calibration, const Recording& recording) {
  return refusal([&] { fsr::calibration::recheckCalibration(calibration, {recording}); });
}

TEST(Recheck, CorrectsAPlantedGainAndOffset) {
  const Recheck result = recheck(worn);
  ASSERT_EQ(result.verdict, RecheckVerdict::kCorrected) << said(result);
  ASSERT_TRUE(result.child.has_value());
  for (const auto& change : result.choice.changes) {
    EXPECT_NEAR(change.gain, 0.95, 0.01);
    EXPECT_NEAR(change.offset, 25, 15);
  }
  EXPECT_LT(result.choice.p, 0.01);
  EXPECT_GT(result.choice.rmse[0], 1.1 * result.choice.nested);
}

// One gain and one offset in counts hold on every surface.
TEST(Recheck, CorrectsSurfacesThatWereNotRechecked) {
  const Recheck result = recheck(worn);
  ASSERT_TRUE(result.child.has_value());
  const Recording test = changed(syntheticRecording(rig(4)), worn);
  const double anew = rmse(trainedOn(changed(syntheticRecording(rig(3)), worn)), test);
  EXPECT_LT(rmse(*result.child, test), 1.1 * anew);
  EXPECT_GT(rmse(parent(), test), 1.2 * anew);
}

TEST(Recheck, LeavesAnUnchangedSheetAlone) {
  for (unsigned seed = 2; seed < 12; ++seed) {
    const Recheck result = recheck(unchanged, seed);
    EXPECT_EQ(result.verdict, RecheckVerdict::kStillGood) << seed << said(result);
    EXPECT_FALSE(result.child.has_value());
    EXPECT_TRUE(result.check.still_good);
  }
}

TEST(Recheck, CorrectsTaxelsThatChangedDifferently) {
  const auto by_taxel = [](double reading, std::size_t taxel) {
    return (0.85 + 0.03 * double(taxel)) * reading;
  };
  const Recheck result = recheck(by_taxel);
  ASSERT_EQ(result.verdict, RecheckVerdict::kCorrected) << said(result);
  EXPECT_EQ(result.choice.model, ChangeModel::kTaxels);
  EXPECT_TRUE(result.child->correction.by_taxel);
  for (std::size_t taxel = 0; taxel < 6; ++taxel)
    EXPECT_NEAR(result.choice.changes[taxel].gain, 0.85 + 0.03 * double(taxel), 0.015);
}

TEST(Recheck, AsksForACalibrationWhereGainAndOffsetDoNotHelp) {
  const auto bent_curve = [](double reading, std::size_t taxel) {
    return 4095 * std::pow(reading / 4095, taxel % 2 == 0 ? 1.8 : 0.6);
  };
  const Recheck result = recheck(bent_curve);
  EXPECT_EQ(result.verdict, RecheckVerdict::kRecalibrate) << said(result);
  EXPECT_FALSE(result.child.has_value());
  EXPECT_FALSE(result.reasons.empty());
}

TEST(Recheck, AsksForACalibrationWhereATaxelIsDead) {
  const Recheck result = recheck([](double reading, std::size_t taxel) { return taxel == 4 ? 0 : reading; });
  EXPECT_EQ(result.verdict, RecheckVerdict::kRecalibrate);
  EXPECT_NE(said(result).find("taxels are dead: (1, 1)"), std::string::npos);
}

TEST(Recheck, CannotTellWearFromOneNewMount) {
  const Recheck result = fsr::calibration::recheckCalibration(parent(), mounts({1.0}, worn));
  EXPECT_EQ(result.verdict, RecheckVerdict::kCannotTell) << said(result);
  EXPECT_FALSE(result.child.has_value());
  ASSERT_EQ(result.reasons.size(), 1u);
  EXPECT_NE(result.reasons[0].find("record two more new mounts"), std::string::npos);
  EXPECT_NE(result.reasons[0].find("--same-mount"), std::string::npos);
}

// Recordings of one mount are one mount, and those without a number are, too.
TEST(Recheck, CountsMountsByTheirNumbers) {
  std::vector<Recording> recordings = mounts({1.0, 1.001, 0.999}, worn);
  for (Recording& recording : recordings) recording.conditions[0].mount = 0;
  const Recheck result = fsr::calibration::recheckCalibration(parent(), recordings);
  EXPECT_EQ(result.verdict, RecheckVerdict::kCannotTell) << said(result);
  ASSERT_TRUE(result.mounts.has_value());
  EXPECT_EQ(result.mounts->mounts, 1u);
}

TEST(Recheck, CorrectsWearThatSeveralMountsHaveInCommon) {
  const Recheck result = fsr::calibration::recheckCalibration(parent(), mounts({1.003, 0.998, 1.0}, worn));
  ASSERT_EQ(result.verdict, RecheckVerdict::kCorrected) << said(result);
  ASSERT_TRUE(result.mounts.has_value());
  EXPECT_EQ(result.mounts->mounts, 3u);
  EXPECT_EQ(result.mounts->sheet.scatter.freedom, 2u);
  EXPECT_LT(result.mounts->sheet.p, 0.05);
  EXPECT_NEAR(result.choice.changes[0].gain, 0.95, 0.015);
}

TEST(Recheck, DoesNotTakeTheScatterOfMountsForWear) {
  const Recheck result =
      fsr::calibration::recheckCalibration(parent(), mounts({0.93, 0.97, 0.99}, unchanged));
  EXPECT_EQ(result.verdict, RecheckVerdict::kCannotTell) << said(result);
  EXPECT_FALSE(result.child.has_value());
  EXPECT_NE(said(result).find("may be the mounts alone"), std::string::npos) << said(result);
}

// Taxels that differ from mount to mount do not make a correction by taxel.
TEST(Recheck, CorrectsAllTaxelsAlikeWhereMountsScatterByTaxel) {
  std::vector<Recording> recordings;
  for (const double scatter : {0.015, 0.015, -0.0075}) {
    const auto mounted = [&](double reading, std::size_t taxel) {
      return 0.9 * (1 + scatter * (double(taxel) - 2.5) / 2.5) * reading;
    };
    const auto mount = std::uint32_t(2 + recordings.size());
    recordings.push_back(changed(syntheticRecording(rig(30 + mount, false)), mounted));
    recordings.back().conditions[0].mount = mount;
  }
  const Recheck result = fsr::calibration::recheckCalibration(parent(), recordings);
  ASSERT_EQ(result.verdict, RecheckVerdict::kCorrected) << said(result);
  EXPECT_EQ(result.choice.model, ChangeModel::kSheet);
  EXPECT_GE(result.mounts->taxels.p, 0.05);
  EXPECT_FALSE(result.child->correction.by_taxel);
}

TEST(Recheck, KnowsTheScatterOfMountsFromTheTraining) {
  Calibration several = parent();
  several.scores.whole.errors.whole.all.rmse = 10e3;
  several.scores.remount.readings = 1000;
  several.scores.remount.rmse = 40e3;
  several.budget.intervals.unit = fsr::calibration::IntervalUnit::kMounts;
  several.budget.intervals.whole.units = 8;  // 4 of each surface
  // 4/3 - 3/4 of the variance between mounts is what left-out mounts have more than left-out sections.
  EXPECT_NEAR(fsr::calibration::trainedScatter(several).deviation,
              std::sqrt((40e3 * 40e3 - 10e3 * 10e3) / (4.0 / 3 - 3.0 / 4)), 1);
  EXPECT_EQ(fsr::calibration::trainedScatter(several).freedom, 6u);
  const Recheck large = fsr::calibration::recheckCalibration(several, mounts({1.0}, worn));
  EXPECT_FALSE(large.child.has_value());
  EXPECT_NE(large.verdict, RecheckVerdict::kCannotTell) << said(large);
  EXPECT_NE(said(large).find("may be the mounts alone"), std::string::npos) << said(large);
  several.scores.remount.rmse = 10.1e3;
  const Recheck small = fsr::calibration::recheckCalibration(several, mounts({1.0}, worn));
  EXPECT_EQ(small.verdict, RecheckVerdict::kCorrected) << said(small);
}

TEST(Recheck, RefusesSeveralMountsOfASheetThatWasNotTakenOut) {
  const std::vector<Recording> recordings = mounts({1.0, 1.0}, worn);
  EXPECT_NE(refusal([&] {
              fsr::calibration::recheckCalibration(parent(), recordings, sameMount());
            }).find("the bags have mounts 2 and 3 of flat"),
            std::string::npos);
}

TEST(Recheck, ComparesReadingsAtTheTemperatureOfTheTraining) {
  Calibration model = parent();
  model.temperature.sensitivity = -0.006;
  model.temperature.reference = 23;
  model.temperature.low = 20;
  model.temperature.high = 40;
  Recording warm = syntheticRecording(rig(2, false));
  for (double& pressure : warm.pressure) pressure *= 1 - 0.006 * 15;
  warm.temperature.assign(warm.scans(), 38.0);
  EXPECT_EQ(fsr::calibration::recheckCalibration(model, {warm}, sameMount()).verdict,
            RecheckVerdict::kStillGood);
  EXPECT_NE(fsr::calibration::recheckCalibration(parent(), {warm}, sameMount()).verdict,
            RecheckVerdict::kStillGood);
}

// The first three seconds at rest, as a session begins.
Recording withRest(const Recording& recording) {
  constexpr std::size_t kScans = 30;
  Recording result = recording;
  const std::size_t taxels = recording.layout.size.taxels();
  const std::vector<std::uint16_t> first(recording.counts.begin(),
                                         recording.counts.begin() + static_cast<std::ptrdiff_t>(taxels));
  for (double& time : result.time) time += 0.1 * kScans;
  for (std::size_t i = kScans; i-- > 0;) {
    result.time.insert(result.time.begin(), 0.1 * double(i));
    result.pressure.insert(result.pressure.begin(), 0.0);
    result.condition.insert(result.condition.begin(), 0u);
    result.counts.insert(result.counts.begin(), first.begin(), first.end());
  }
  return result;
}

TEST(Recheck, TaresSessionsWhereTheCalibrationExpectsIt) {
  Calibration tared = parent();
  tared.session_zero.tare = fsr::calibration::SessionTare::kTablesAlone;
  for (auto& table : tared.tables.tables) {
    for (float& pressure : table.pressure) pressure += 30e3F;  // as the zero of a session
  }
  const Recording plain = syntheticRecording(rig(2, false));
  const Recheck without = fsr::calibration::recheckCalibration(tared, {plain});
  EXPECT_NE(without.verdict, RecheckVerdict::kStillGood);
  ASSERT_FALSE(without.remarks.empty());
  EXPECT_NE(without.remarks.front().find("does not start with 2 s at rest"), std::string::npos);
  const Recheck with = fsr::calibration::recheckCalibration(tared, {withRest(plain)});
  EXPECT_EQ(with.verdict, RecheckVerdict::kStillGood) << said(with);
  EXPECT_TRUE(with.remarks.empty());
  const Recheck of_worn =
      fsr::calibration::recheckCalibration(tared, {withRest(changed(plain, worn))}, sameMount());
  ASSERT_TRUE(of_worn.child.has_value()) << said(of_worn);
  EXPECT_NEAR(of_worn.choice.changes[0].gain, 0.95, 0.015);
}

TEST(Recheck, RefusesWhatDoesNotFitTheParent) {
  const Recording good = changed(syntheticRecording(rig(2, false)), worn);
  Calibration ours = parent();
  ours.sensor.serial = "FSR-0001";
  Recording other = good;
  other.sensor.serial = "FSR-0002";
  EXPECT_NE(
      refusalOf(ours, other).find("serial number \"FSR-0002\", but calibration 0123456789ab was trained"),
      std::string::npos);
  Recording surface = good;
  surface.conditions[0].name = "cylinder_3cm";
  surface.conditions[0].curvature = {{33.3, 0, 0}};
  EXPECT_NE(refusalOf(parent(), surface).find("recheck on one of flat, cylinder_7cm"), std::string::npos);
  Recording without = good;
  without.pressure.clear();
  EXPECT_NE(refusalOf(parent(), without).find("has no chamber_pressure"), std::string::npos);
  SyntheticRig larger = rig(2, false);
  larger.size = {3, 3};
  EXPECT_NE(refusalOf(parent(), syntheticRecording(larger)).find("but the calibration is for"),
            std::string::npos);
  SyntheticRig few = rig(2, false);
  few.cycles = 2;
  EXPECT_NE(refusalOf(parent(), syntheticRecording(few)).find("but the bags have 2; record more cycles"),
            std::string::npos);
  SyntheticRig low = rig(2, false);
  low.peak = 200e3;
  EXPECT_NE(refusalOf(parent(), syntheticRecording(low)).find("but the bags have 0; record more cycles"),
            std::string::npos);
  EXPECT_NE(refusal([] { fsr::calibration::recheckCalibration(parent(), {}); }).find("there is no bag"),
            std::string::npos);
}

// A small cycle runs through another loop than those of the training, and a loading alone through half a
// loop.
TEST(Recheck, LeavesOutCyclesThatAreSmallOrNotWhole) {
  SyntheticRig half = rig(3, false);
  half.peak = 300e3;
  half.cycles = 2;
  Recording recording = syntheticRecording(rig(2, false));
  const Recheck whole = fsr::calibration::recheckCalibration(parent(), {recording});
  EXPECT_EQ(whole.cycles, 5u);
  EXPECT_TRUE(whole.remarks.empty());
  const Recheck mixed = fsr::calibration::recheckCalibration(parent(), {recording, syntheticRecording(half)});
  EXPECT_EQ(mixed.cycles, 5u);
  EXPECT_EQ(mixed.choice.rmse, whole.choice.rmse);
  ASSERT_EQ(mixed.remarks.size(), 1u);
  EXPECT_NE(mixed.remarks[0].find("sheet_3.bag, flat: 2 cycles are left out"), std::string::npos);
  const std::size_t taxels = recording.layout.size.taxels();
  recording.time.resize(450);  // up to the peak of the fifth cycle
  recording.pressure.resize(450);
  recording.condition.resize(450);
  recording.counts.resize(450 * taxels);
  EXPECT_EQ(fsr::calibration::recheckCalibration(parent(), {recording}).cycles, 4u);
}

TEST(Recheck, RefusesTheChildOfAChild) {
  const Recheck first = recheck(worn);
  ASSERT_TRUE(first.child.has_value());
  Calibration child = *first.child;
  child.id = "ba9876543210";
  EXPECT_EQ(
      refusalOf(child, syntheticRecording(rig(2, false))),
      "calibration ba9876543210 is itself a correction of 0123456789ab; correct that one again with the "
      "new bags, or train anew");
}

class CorrectedFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("recheck_test_" + std::to_string(::getpid()));
};

TEST_F(CorrectedFile, KeepsItsAncestryAndAnswers) {
  const Recheck result = recheck(worn);
  ASSERT_TRUE(result.child.has_value());
  const std::string path = (folder_ / "child.h5").string();
  saveCalibration(*result.child, path);
  const Calibration loaded = fsr::calibration::loadCalibration(path);
  const fsr::calibration::Correction &written = result.child->correction, &read = loaded.correction;
  ASSERT_TRUE(read.present());
  EXPECT_EQ(read.parent, "0123456789ab");
  EXPECT_EQ(read.parent_date, parent().provenance.date);
  EXPECT_EQ(read.date, written.date);
  EXPECT_EQ(read.tool_version, written.tool_version);
  EXPECT_EQ(read.by_taxel, written.by_taxel);
  EXPECT_EQ(read.gain, written.gain);
  EXPECT_EQ(read.offset, written.offset);
  EXPECT_EQ(read.surfaces, std::vector<std::string>{"flat"});
  ASSERT_EQ(read.bags.size(), 1u);
  EXPECT_EQ(read.bags[0].name, "sheet_2.bag");
  EXPECT_EQ(read.cycles, 5u);
  EXPECT_EQ(read.rmse_before, written.rmse_before);
  EXPECT_EQ(read.rmse, written.rmse);
  EXPECT_EQ(read.expected_rmse, written.expected_rmse);
  EXPECT_EQ(loaded.coverage.conditions.size(), parent().coverage.conditions.size());
  EXPECT_EQ(loaded.tables.tables[0].pressure, result.child->tables.tables[0].pressure);

  // 1,000 counts of before read 975 today and mean the same.
  EXPECT_NEAR(loaded.tables.tables[0].pressure[975], parent().tables.tables[0].pressure[1000],
              0.05 * parent().tables.tables[0].pressure[1000]);
}

TEST_F(CorrectedFile, CannotBeMerged) {
  const Recheck result = recheck(worn);
  ASSERT_TRUE(result.child.has_value());
  const std::string path = (folder_ / "child.h5").string();
  saveCalibration(*result.child, path);
  const Calibration loaded =
      fsr::calibration::loadCalibration(path, fsr::calibration::CalibrationParts::kAll);
  const std::string sentence = refusal([&] {
    fsr::calibration::mergeCalibrations({{"child.h5", loaded}, {"other.h5", parent()}});
  });
  EXPECT_NE(sentence.find("child.h5: holds no statistics to merge"), std::string::npos) << sentence;
}

TEST_F(CorrectedFile, OldFilesHaveNoParent) {
  for (const char* const name : {"schema_1.h5", "schema_2.h5"}) {
    const Calibration old =
        fsr::calibration::loadCalibration(test_support::sourceDir() + "/test/data/calibrations/" + name);
    EXPECT_FALSE(old.correction.present()) << name;
  }
}

}  // namespace
