#include "check/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "calibration/merge.h"
#include "check/correction.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/memory_rig.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"

namespace {

using fsr::calibration::Calibration;
using fsr::check::ChangeModel;
using fsr::check::CheckResult;
using fsr::check::Verdict;
using fsr::dataset::Recording;
using test_support::refusal;
using test_support::SyntheticRig;

// Reading of today for a reading of before; taxel.
using Change = std::function<double(double reading, std::size_t taxel)>;

// The sheet has a loop, as real ones do: without one the smallest change would be worth a correction.
SyntheticRig loopedRig(unsigned seed, bool bent = true) {
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
  problem.options.history = {false, fsr::calibration::HistoryFamily::kNone};
  problem.options.choose_bandwidth = false;
  Calibration calibration = fsr::calibration::calibrate(problem);
  calibration.id = "0123456789ab";
  return calibration;
}

const Calibration& parent() {
  static const Calibration instance = trainedOn(syntheticRecording(loopedRig(1)));
  return instance;
}

// The sheet was not taken out since the training.
fsr::check::CheckOptions sameMount() {
  fsr::check::CheckOptions options;
  options.same_mount = true;
  return options;
}

CheckResult decide(const Calibration& calibration, const std::vector<Recording>& recordings,
                   fsr::check::CheckOptions options = {}) {
  options.correct = true;
  return check(calibration, recordings, options);
}

CheckResult recheck(const Change& change, unsigned seed = 2, bool bent = false) {
  return decide(parent(), {changed(syntheticRecording(loopedRig(seed, bent)), change)}, sameMount());
}

// One bag, one file, one expected error.
TEST(Check, StatesTheExpectedErrorOfTheMap) {
  const std::vector<Recording> recordings = {syntheticRecording(loopedRig(2, false))};
  const double checked = fsr::check::errorsOfMap(parent(), recordings).whole.expectedRmse();
  EXPECT_DOUBLE_EQ(decide(parent(), recordings, sameMount()).correction->expected, checked);
  const Change worn = [](double reading, std::size_t) { return 0.9 * reading + 30; };
  const std::vector<Recording> other = {changed(recordings.front(), worn)};
  const CheckResult corrected = decide(parent(), other, sameMount());
  ASSERT_EQ(corrected.verdict, Verdict::kCorrected);
  EXPECT_DOUBLE_EQ(corrected.correction->expected,
                   fsr::check::errorsOfMap(parent(), other).whole.expectedRmse());
}

// Flat on mounts that read `gains` as much; numbers 2, 3, ...
std::vector<Recording> mounts(const std::vector<double>& gains, const Change& change) {
  std::vector<Recording> recordings;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const double gain = gains[i];
    const auto mounted = [&](double reading, std::size_t taxel) { return gain * change(reading, taxel); };
    recordings.push_back(changed(syntheticRecording(loopedRig(20 + unsigned(i), false)), mounted));
    recordings.back().conditions[0].mount = std::uint32_t(2 + i);
  }
  return recordings;
}

// Verdict, reasons and remarks, one a line.
std::string said(const CheckResult& result) {
  std::string text = verdictName(result.verdict);
  for (const std::string& reason : result.reasons) text += '\n' + reason;
  for (const std::string& remark : result.correction ? result.correction->remarks : result.map.remarks)
    text += '\n' + remark;
  return text;
}

double unchanged(double reading, std::size_t) {
  return reading;
}
double worn(double reading, std::size_t) {
  return 0.95 * reading + 25;
}

double rmse(const Calibration& calibration, const Recording& recording) {
  return fsr::check::errorsOfMap(calibration, {recording}).whole.rmse();
}

TEST(Check, CorrectsAPlantedGainAndOffset) {
  const CheckResult result = recheck(worn);
  ASSERT_EQ(result.verdict, Verdict::kCorrected) << said(result);
  ASSERT_TRUE(result.child.has_value());
  for (const auto& change : result.correction->choice.changes) {
    EXPECT_NEAR(change.gain, 0.95, 0.01);
    EXPECT_NEAR(change.offset, 25, 15);
  }
  EXPECT_LT(result.correction->choice.p, 0.01);
  EXPECT_GT(result.correction->choice.rmse[0], 1.1 * result.correction->choice.nested);
}

// One gain and one offset in counts hold on every surface.
TEST(Check, CorrectsSurfacesThatWereNotRechecked) {
  const CheckResult result = recheck(worn);
  ASSERT_TRUE(result.child.has_value());
  const Recording test = changed(syntheticRecording(loopedRig(4)), worn);
  const double anew = rmse(trainedOn(changed(syntheticRecording(loopedRig(3)), worn)), test);
  EXPECT_LT(rmse(*result.child, test), 1.1 * anew);
  EXPECT_GT(rmse(parent(), test), 1.2 * anew);
}

TEST(Check, LeavesAnUnchangedSheetAlone) {
  for (unsigned seed = 2; seed < 12; ++seed) {
    const CheckResult result = recheck(unchanged, seed);
    EXPECT_EQ(result.verdict, Verdict::kStillGood) << seed << said(result);
    EXPECT_FALSE(result.child.has_value());
    EXPECT_TRUE(result.map.faults.empty());
  }
}

TEST(Check, CorrectsTaxelsThatChangedDifferently) {
  const auto by_taxel = [](double reading, std::size_t taxel) {
    return (0.85 + 0.03 * double(taxel)) * reading;
  };
  const CheckResult result = recheck(by_taxel);
  ASSERT_EQ(result.verdict, Verdict::kCorrected) << said(result);
  EXPECT_EQ(result.correction->choice.model, ChangeModel::kTaxels);
  EXPECT_TRUE(result.child->correction.by_taxel);
  for (std::size_t taxel = 0; taxel < 6; ++taxel)
    EXPECT_NEAR(result.correction->choice.changes[taxel].gain, 0.85 + 0.03 * double(taxel), 0.015);
}

TEST(Check, AsksForACalibrationWhereGainAndOffsetDoNotHelp) {
  const auto bent_curve = [](double reading, std::size_t taxel) {
    return 4095 * std::pow(reading / 4095, taxel % 2 == 0 ? 1.8 : 0.6);
  };
  const CheckResult result = recheck(bent_curve);
  EXPECT_EQ(result.verdict, Verdict::kRecalibrate) << said(result);
  EXPECT_FALSE(result.child.has_value());
  EXPECT_FALSE(result.reasons.empty());
}

TEST(Check, AsksForACalibrationWhereATaxelIsDead) {
  const CheckResult result =
      recheck([](double reading, std::size_t taxel) { return taxel == 4 ? 0 : reading; });
  EXPECT_EQ(result.verdict, Verdict::kRecalibrate);
  EXPECT_NE(said(result).find("taxels are dead: (1, 1)"), std::string::npos);
}

TEST(Check, CannotTellWearFromOneNewMount) {
  const CheckResult result = decide(parent(), mounts({1.0}, worn));
  EXPECT_EQ(result.verdict, Verdict::kCannotTell) << said(result);
  EXPECT_FALSE(result.child.has_value());
  ASSERT_EQ(result.reasons.size(), 1u);
  EXPECT_NE(result.reasons[0].find("record two more new mounts"), std::string::npos);
  EXPECT_NE(result.reasons[0].find("--same-mount"), std::string::npos);
}

// Recordings of one mount are one mount, and those without a number are, too.
TEST(Check, CountsMountsByTheirNumbers) {
  std::vector<Recording> recordings = mounts({1.0, 1.001, 0.999}, worn);
  for (Recording& recording : recordings) recording.conditions[0].mount = 0;
  const CheckResult result = decide(parent(), recordings);
  EXPECT_EQ(result.verdict, Verdict::kCannotTell) << said(result);
  ASSERT_TRUE(result.correction->mounts.has_value());
  EXPECT_EQ(result.correction->mounts->mounts, 1u);
}

TEST(Check, CorrectsWearThatSeveralMountsHaveInCommon) {
  const CheckResult result = decide(parent(), mounts({1.003, 0.998, 1.0}, worn));
  ASSERT_EQ(result.verdict, Verdict::kCorrected) << said(result);
  ASSERT_TRUE(result.correction->mounts.has_value());
  EXPECT_EQ(result.correction->mounts->mounts, 3u);
  EXPECT_EQ(result.correction->mounts->sheet.scatter.freedom, 2u);
  EXPECT_LT(result.correction->mounts->sheet.p, 0.05);
  EXPECT_NEAR(result.correction->choice.changes[0].gain, 0.95, 0.015);
}

TEST(Check, DoesNotTakeTheScatterOfMountsForWear) {
  const CheckResult result = decide(parent(), mounts({0.93, 0.97, 0.99}, unchanged));
  EXPECT_EQ(result.verdict, Verdict::kCannotTell) << said(result);
  EXPECT_FALSE(result.child.has_value());
  EXPECT_NE(said(result).find("may be the mounts alone"), std::string::npos) << said(result);
}

// Taxels that differ from mount to mount do not make a correction by taxel.
TEST(Check, CorrectsAllTaxelsAlikeWhereMountsScatterByTaxel) {
  std::vector<Recording> recordings;
  for (const double scatter : {0.015, 0.015, -0.0075}) {
    const auto mounted = [&](double reading, std::size_t taxel) {
      return 0.9 * (1 + scatter * (double(taxel) - 2.5) / 2.5) * reading;
    };
    const auto mount = std::uint32_t(2 + recordings.size());
    recordings.push_back(changed(syntheticRecording(loopedRig(30 + mount, false)), mounted));
    recordings.back().conditions[0].mount = mount;
  }
  const CheckResult result = decide(parent(), recordings);
  ASSERT_EQ(result.verdict, Verdict::kCorrected) << said(result);
  EXPECT_EQ(result.correction->choice.model, ChangeModel::kSheet);
  EXPECT_GE(result.correction->mounts->taxels.p, 0.05);
  EXPECT_FALSE(result.child->correction.by_taxel);
}

TEST(Check, KnowsTheScatterOfMountsFromTheTraining) {
  Calibration several = parent();
  several.scores.whole.errors.whole.all.rmse = 10e3;
  several.scores.remount.readings = 1000;
  several.scores.remount.rmse = 40e3;
  several.budget.intervals.unit = fsr::calibration::IntervalUnit::kMounts;
  several.budget.intervals.whole.units = 8;  // 4 of each surface
  // 4/3 - 3/4 of the variance between mounts is what left-out mounts have more than left-out sections.
  EXPECT_NEAR(fsr::check::trainedScatter(several).deviation,
              std::sqrt((40e3 * 40e3 - 10e3 * 10e3) / (4.0 / 3 - 3.0 / 4)), 1);
  EXPECT_EQ(fsr::check::trainedScatter(several).freedom, 6u);
  const CheckResult large = decide(several, mounts({1.0}, worn));
  EXPECT_FALSE(large.child.has_value());
  EXPECT_NE(large.verdict, Verdict::kCannotTell) << said(large);
  EXPECT_NE(said(large).find("may be the mounts alone"), std::string::npos) << said(large);
  several.scores.remount.rmse = 10.1e3;
  const CheckResult small = decide(several, mounts({1.0}, worn));
  EXPECT_EQ(small.verdict, Verdict::kCorrected) << said(small);
}

TEST(Check, RefusesSeveralMountsOfASheetThatWasNotTakenOut) {
  const std::vector<Recording> recordings = mounts({1.0, 1.0}, worn);
  EXPECT_NE(refusal([&] {
              decide(parent(), recordings, sameMount());
            }).find("the bags have mounts 2 and 3 of flat"),
            std::string::npos);
}

TEST(Check, ComparesReadingsAtTheTemperatureOfTheTraining) {
  Calibration model = parent();
  model.temperature.sensitivity = -0.006;
  model.temperature.reference = 23;
  model.temperature.low = 20;
  model.temperature.high = 40;
  Recording warm = syntheticRecording(loopedRig(2, false));
  for (double& pressure : warm.pressure) pressure *= 1 - 0.006 * 15;
  warm.temperature.assign(warm.scans(), 38.0);
  EXPECT_EQ(decide(model, {warm}, sameMount()).verdict, Verdict::kStillGood);
  EXPECT_NE(decide(parent(), {warm}, sameMount()).verdict, Verdict::kStillGood);
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

TEST(Check, TaresSessionsWhereTheCalibrationExpectsIt) {
  Calibration tared = parent();
  tared.session_zero.tare = fsr::calibration::SessionTare::kTablesAlone;
  for (auto& table : tared.tables.tables) {
    for (float& pressure : table.pressure) pressure += 30e3F;  // as the zero of a session
  }
  const Recording plain = syntheticRecording(loopedRig(2, false));
  const CheckResult without = decide(tared, {plain});
  EXPECT_NE(without.verdict, Verdict::kStillGood);
  ASSERT_FALSE(without.correction->remarks.empty());
  EXPECT_NE(
      without.correction->remarks.front().find(": not tared, because it does not start with 2 s at rest"),
      std::string::npos);
  const CheckResult with = decide(tared, {withRest(plain)});
  EXPECT_EQ(with.verdict, Verdict::kStillGood) << said(with);
  EXPECT_TRUE(with.correction->remarks.empty());
  const CheckResult of_worn = decide(tared, {withRest(changed(plain, worn))}, sameMount());
  ASSERT_TRUE(of_worn.child.has_value()) << said(of_worn);
  EXPECT_NEAR(of_worn.correction->choice.changes[0].gain, 0.95, 0.015);
}

// A session that reads `offset` more [Pa].
Recording shiftedSession(double offset) {
  test_support::MemoryRig remembering;
  remembering.loop = 0.05;
  Recording recording = test_support::memorySession(2, 0, remembering);
  return changed(recording, [=](double reading, std::size_t) { return reading + offset * 5e-3; });
}

TEST(Check, AdvisesATareWhereItTakesTheErrorAway) {
  fsr::calibration::CalibrationProblem problem;
  problem.recordings = {shiftedSession(0)};
  problem.options.history = {false, fsr::calibration::HistoryFamily::kNone};
  problem.options.zero = fsr::calibration::ZeroChoice::kNone;
  const Calibration calibration = fsr::calibration::calibrate(problem);
  const Recording shifted = shiftedSession(25e3);
  fsr::check::CheckOptions options;
  options.limits.beyond_share = 0.2;  // the peaks read more than any reading of the training
  const CheckResult advised = fsr::check::check(calibration, {shifted}, options);
  EXPECT_EQ(advised.verdict, Verdict::kTare) << said(advised);
  ASSERT_EQ(advised.reasons.size(), 1u);
  EXPECT_EQ(advised.reasons.front().find("one tare takes "), 0u) << advised.reasons.front();
  EXPECT_NE(advised.reasons.front().find(" % off (from 2"), std::string::npos) << advised.reasons.front();
  Recording loaded = shifted;
  for (std::size_t i = 0; i < 60; ++i) loaded.pressure[i] = 300e3;
  const CheckResult not_tared = fsr::check::check(calibration, {loaded}, options);
  EXPECT_EQ(not_tared.verdict, Verdict::kRecalibrate);
  EXPECT_NE(
      said(not_tared).find("session_2.bag, flat: not tared, because it does not start with 2 s at rest: "
                           "the chamber is at 300.0 kPa, which is a load"),
      std::string::npos)
      << said(not_tared);
}

TEST(Check, RefusesWhatDoesNotFitTheParent) {
  Recording other = syntheticRecording(loopedRig(2, false)), surface = other, without = other;
  other.sensor.serial = "FSR-0002";
  surface.conditions[0].name = "cylinder_3cm";
  surface.conditions[0].curvature = {{33.3, 0, 0}};
  without.pressure.clear();
  SyntheticRig larger = loopedRig(2, false), few = larger, low = larger;
  larger.size = {3, 3};
  few.cycles = 2;
  low.peak = 200e3;
  const std::vector<std::pair<std::vector<Recording>, std::string>> cases = {
      {{other}, "serial number \"FSR-0002\", but calibration 0123456789ab was trained"},
      {{surface}, "recheck on one of flat, cylinder_7cm"},
      {{without}, "has no chamber_pressure"},
      {{syntheticRecording(larger)}, "but the calibration is for"},
      {{syntheticRecording(few)}, "but the bags have 2; record more cycles"},
      {{syntheticRecording(low)}, "but the bags have 0; record more cycles"},
      {{}, "there is no bag"}};
  for (const auto& [recordings, sentence] : cases) {
    const std::string said = refusal([&bags = recordings] { decide(parent(), bags); });
    EXPECT_NE(said.find(sentence), std::string::npos) << said;
  }
}

// A small cycle runs through another loop than those of the training, and a loading alone through half a
// loop.
TEST(Check, LeavesOutCyclesThatAreSmallOrNotWhole) {
  SyntheticRig half = loopedRig(3, false);
  half.peak = 300e3;
  half.cycles = 2;
  const Recording recording = syntheticRecording(loopedRig(2, false));
  const CheckResult whole = decide(parent(), {recording});
  EXPECT_EQ(whole.correction->cycles, 5u);
  EXPECT_TRUE(whole.correction->remarks.empty());
  const CheckResult mixed = decide(parent(), {recording, syntheticRecording(half)});
  EXPECT_EQ(mixed.correction->cycles, 5u);
  EXPECT_EQ(mixed.correction->choice.rmse, whole.correction->choice.rmse);
  ASSERT_EQ(mixed.correction->remarks.size(), 1u);
  EXPECT_NE(mixed.correction->remarks[0].find("sheet_3.bag, flat: 2 cycles are left out"), std::string::npos);
  const Recording cut = test_support::partOf(recording, 0, 450);  // up to the peak of the fifth cycle
  EXPECT_EQ(decide(parent(), {cut}).correction->cycles, 4u);
}

TEST(Check, RefusesTheChildOfAChild) {
  const CheckResult first = recheck(worn);
  ASSERT_TRUE(first.child.has_value());
  Calibration child = *first.child;
  child.id = "ba9876543210";
  EXPECT_TRUE(test_support::holds(refusal([&] { decide(child, {syntheticRecording(loopedRig(2, false))}); }),
                                  {"ba9876543210 is itself a correction of 0123456789ab"}));
}

class CorrectedFile : public test_support::FolderTest {
 protected:
  Calibration savedAndLoaded() const {
    saveCalibration(result_.child.value(), path("child.h5"));
    return fsr::calibration::loadCalibration(path("child.h5"), fsr::calibration::CalibrationParts::kAll);
  }

  const CheckResult result_ = recheck(worn);
};

TEST_F(CorrectedFile, KeepsItsAncestryAndAnswers) {
  const Calibration loaded = savedAndLoaded();
  const fsr::calibration::Correction &written = result_.child->correction, &read = loaded.correction;
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
  EXPECT_EQ(loaded.tables.tables[0].pressure, result_.child->tables.tables[0].pressure);

  // 1,000 counts of before read 975 today and mean the same.
  EXPECT_NEAR(loaded.tables.tables[0].pressure[975], parent().tables.tables[0].pressure[1000],
              0.05 * parent().tables.tables[0].pressure[1000]);
}

TEST_F(CorrectedFile, CannotBeMerged) {
  const Calibration loaded = savedAndLoaded();
  EXPECT_TRUE(test_support::holds(
      refusal([&] {
        fsr::calibration::mergeCalibrations({{"child.h5", loaded}, {"other.h5", parent()}});
      }),
      {"child.h5: holds no statistics to merge"}));
}

TEST(Correction, IsAbsentInOldFiles) {
  for (const char* const name : {"schema_1.h5", "schema_2.h5"}) {
    const Calibration old =
        fsr::calibration::loadCalibration(test_support::sourceDir() + "/test/data/calibrations/" + name);
    EXPECT_FALSE(old.correction.present()) << name;
  }
}

}  // namespace
