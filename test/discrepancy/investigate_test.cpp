// Plants an effect in a simulated session and checks that the verdict names it.

#include "fsr_pressure_map/discrepancy/discrepancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/answer.h"
#include "discrepancy/prove/next_experiment.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/session.h"
#include "support/holds.h"

namespace {

using fsr::discrepancy::answerTo;
using fsr::discrepancy::DiscrepancyProblem;
using fsr::discrepancy::DiscrepancyReport;
using fsr::discrepancy::Verdict;
using Ids = std::vector<std::string>;

using fsr::discrepancy::kNoise;
using fsr::discrepancy::planted::kOneSpeed;
using fsr::discrepancy::planted::simulation;

// Two speeds with dwells, in fewer cycles than planted::kTwoSpeeds.
const std::string kTwoSpeeds = fsr::discrepancy::planted::withProgram(
    R"(  - hold: {pressure: 310000, rate: 40000, duration: 8}
  - hold: {pressure: 620000, rate: 40000, duration: 8}
  - rest: {rate: 40000, duration: 4}
  - hold: {pressure: 310000, rate: 8000, duration: 15}
  - hold: {pressure: 620000, rate: 8000, duration: 15}
  - rest: {rate: 8000, duration: 4}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 3}
  - cycles: {peak: 620000, rate: 8000, dwell_peak: 8, cycles: 1}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 2}
)");

DiscrepancyProblem planted(const std::string& text, const std::string& more) {
  return fsr::discrepancy::planted::problem(text, more);
}

double valueOf(const DiscrepancyReport& report, const std::string& parameter) {
  for (const fsr::discrepancy::FittedParameter& fitted : report.effects.at(0).parameters) {
    if (fitted.name == parameter) return fitted.value;
  }
  return -1;
}

// The gap is the noise, the floor as well, and no share of it is closed.
TEST(Investigate, IsSilentWhereNothingIsHidden) {
  for (const std::string& text : {fsr::discrepancy::planted::kTwoSpeeds, std::string(kOneSpeed)}) {
    const DiscrepancyReport report = answerTo(planted(text, ""));
    EXPECT_EQ(report.verdict, Verdict::kNone) << report.sentence;
    EXPECT_TRUE(report.effects.empty());
    EXPECT_TRUE(std::isnan(report.at_map));
    EXPECT_EQ(report.scatter.size(), 3u);
    EXPECT_NEAR(report.gap.before, kNoise, 0.05 * kNoise);
    EXPECT_EQ(report.gap.before, report.gap.after);
    EXPECT_NEAR(report.gap.floor_bracket.low, kNoise, 0.05 * kNoise);
    EXPECT_NEAR(report.gap.floor_bracket.high, kNoise, 0.1 * kNoise);
    EXPECT_TRUE(std::isnan(report.gap.closed));
    EXPECT_TRUE(std::isnan(report.gap.closed_interval.low));
    const auto& seen = report.smallest_seen;
    const auto loop =
        std::find_if(seen.begin(), seen.end(), [](const auto& s) { return s.id == "hysteresis"; });
    ASSERT_NE(loop, seen.end());
    EXPECT_GT(loop->at_map, 0) << "a loop narrower than any in a data sheet would be seen as well";
  }
}

// A loop holds on surfaces and speeds that it was not sized on.
TEST(Investigate, NamesALoopAndAnswersTheQuestionsOfTheUser) {
  DiscrepancyProblem problem =
      planted(fsr::discrepancy::planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n");
  problem.options.ask = {"crosstalk", "hysteresis", "time_skew", "white_noise"};
  const DiscrepancyReport report = answerTo(problem);
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_GT(report.at_map, report.least_gap);
  Ids answers;
  for (const fsr::discrepancy::Answer& answer : report.answers) answers.push_back(answer.answer);
  EXPECT_EQ(answers, (Ids{"not_identifiable", "found", "excluded", "in_simulation"}));
  EXPECT_GT(report.answers.at(2).at_map, 0);
  EXPECT_NEAR(report.gap.after, kNoise, 0.05 * kNoise);
  EXPECT_NEAR(report.gap.closed, 1, 0.01);
  EXPECT_EQ(report.gap.left_out, 0u);
  ASSERT_EQ(report.gap.covered.size(), 3u);
  EXPECT_NEAR(report.gap.covered[0].pressure.high, 620e3, 3e3);
  EXPECT_EQ(report.gap.held_out_by, (Ids{"cycles", "condition", "protocol"}));
  EXPECT_TRUE(report.gap.missing.empty());
  ASSERT_EQ(report.gap.foretold.size(), 2u);
  for (const fsr::discrepancy::HeldOutGap& held : report.gap.foretold) {
    EXPECT_GT(held.closed, 0.9) << held.by;
    EXPECT_LE(held.closed_interval.low, held.closed);
    for (const auto& [name, closed] : held.parts) EXPECT_GT(closed, 0.8) << name;
  }
  problem = planted(kOneSpeed, "");
  problem.options.ask = {"crosstalk"};
  EXPECT_EQ(answerTo(problem).verdict, Verdict::kNotIdentifiable);
}

TEST(Investigate, NamesTwoEffects) {
  const DiscrepancyReport report =
      answerTo(planted(kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n  time_skew: {delay: 0.5}\n"));
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  Ids names;
  for (const auto& effect : report.effects) names.push_back(effect.id);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (Ids{"hysteresis", "time_skew"}));
}

// The loop is 5 % of full scale, so with a least gap of 200 kPa it does not matter.
TEST(Investigate, NamesNoEffectBelowTheLeastGap) {
  DiscrepancyProblem problem = planted(kOneSpeed, "  hysteresis: {loop_width: 0.05}\n");
  problem.options.least_gap = 200e3;
  problem.options.ask = {"hysteresis"};
  const DiscrepancyReport report = answerTo(problem);
  ASSERT_EQ(report.verdict, Verdict::kNone) << report.sentence;
  ASSERT_FALSE(report.too_small.empty());
  EXPECT_EQ(report.least_gap, 200e3);
  EXPECT_NE(report.sentence.find("least gap"), std::string::npos) << report.sentence;
}

TEST(Investigate, NamesCreepAndALeakApart) {
  const DiscrepancyReport creep = answerTo(planted(kTwoSpeeds, "  creep: {per_decade: 0.03}\n"));
  ASSERT_FALSE(creep.credible_set.empty()) << creep.sentence;
  EXPECT_EQ(creep.credible_set.at(0), std::vector<std::string>{"creep"});
  const DiscrepancyReport leak =
      answerTo(planted(kTwoSpeeds, "  seal_leak: {time_constant: 900, carried_over: false}\n"));
  ASSERT_FALSE(leak.credible_set.empty()) << leak.sentence;
  EXPECT_EQ(leak.credible_set.at(0), std::vector<std::string>{"seal_leak"});
  ASSERT_TRUE(leak.added.effect("seal_leak"));
  EXPECT_FALSE(leak.added.effect("seal_leak")->carried_over) << "as it was planted";
  EXPECT_GT(leak.gap.closed, 0.9);
}

// Its change of the reading is far from linear in its share.
TEST(Investigate, NamesALeakThatTakesMostOfTheLoadAway) {
  const DiscrepancyReport leak =
      answerTo(planted(kTwoSpeeds, "  seal_leak: {time_constant: 110, carried_over: false}\n"));
  ASSERT_FALSE(leak.credible_set.empty()) << leak.sentence;
  EXPECT_EQ(leak.credible_set.at(0), std::vector<std::string>{"seal_leak"}) << leak.sentence;
  ASSERT_TRUE(leak.added.effect("seal_leak"));
  EXPECT_NEAR(leak.added.effect("seal_leak")->values.at("time_constant"), 110, 10);
}

TEST(Investigate, FindsARowThatFails) {
  const DiscrepancyReport row =
      answerTo(planted(kTwoSpeeds, "  row_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n"));
  ASSERT_EQ(row.verdict, Verdict::kNamed) << row.sentence;
  EXPECT_EQ(row.effects.at(0).id, "row_fault");
  EXPECT_EQ(row.where.taxels, (std::vector<std::size_t>{4, 5, 6, 7}));
  EXPECT_GT(row.gap.closed, 0.9) << "with the spells of this row";
}

TEST(Investigate, NamesTaxelsThatAreDeadOrStuck) {
  const DiscrepancyReport dead =
      answerTo(planted(kTwoSpeeds, "  dead_taxel: {taxels: 1, first: 5, start: 1200}\n"));
  ASSERT_EQ(dead.verdict, Verdict::kNamed) << dead.sentence;
  EXPECT_EQ(dead.effects.at(0).id, "dead_taxel");
  EXPECT_EQ(dead.where.taxels, std::vector<std::size_t>{5});
  EXPECT_GT(dead.gap.before, dead.gap.after);
  const DiscrepancyReport stuck =
      answerTo(planted(kTwoSpeeds, "  stuck_taxel: {taxels: 1, first: 2, start: 1200, value: -1}\n"));
  ASSERT_EQ(stuck.verdict, Verdict::kNamed) << stuck.sentence;
  EXPECT_EQ(stuck.effects.at(0).id, "stuck_taxel");
  EXPECT_EQ(stuck.where.taxels, std::vector<std::size_t>{2});
  // As written, the simulation fails where and when the sheet did.
  const DiscrepancyReport two =
      answerTo(planted(kTwoSpeeds, "  stuck_taxel: {spells: [2, 1200, 1e9, -1, 9, 1500, 1e9, -1]}\n"));
  EXPECT_EQ(two.where.taxels, (std::vector<std::size_t>{2, 9}));
  for (const DiscrepancyReport* fault : {&dead, &stuck, &two}) EXPECT_GT(fault->gap.closed, 0.9);
}

// A few taxels that stick once and follow a little of the load are no drift of the sheet.
TEST(Investigate, NamesAFaultWhereTaxelsHardlyFollowTheLoad) {
  for (const double share : {0.03, 0.1}) {
    const DiscrepancyReport report = answerTo(fsr::discrepancy::planted::problemReading(
        kTwoSpeeds, [&](const fsr::discrepancy::planted::Changed& now) {
          const bool sticks = now.taxel == 2 && now.time > 0.5 * now.whole;
          return sticks ? 1500 + share * now.count : now.count;
        }));
    ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
    EXPECT_EQ(report.effects.at(0).id, "stuck_taxel");
    EXPECT_EQ(report.effects.size(), 1u);
  }
}

TEST(Investigate, NamesATaxelDeadThatIsSilentOnAWholeSurface) {
  const DiscrepancyReport report = answerTo(fsr::discrepancy::planted::problemReading(
      kTwoSpeeds, [](const fsr::discrepancy::planted::Changed& now) {
        return now.taxel == 2 && now.recording == 1 ? 0 : now.count;
      }));
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "dead_taxel");
  EXPECT_EQ(report.where.taxels, std::vector<std::size_t>{2});
  EXPECT_GT(report.gap.closed, 0.9);
}

TEST(Investigate, FindsTheHumOfTheMains) {
  std::string rig = kTwoSpeeds;  // 50 Hz is no multiple of its scan rate
  rig.replace(rig.find("scan_rate: 2.5"), 14, "scan_rate: 2.7");
  const DiscrepancyReport report =
      answerTo(planted(rig, "  mains_pickup: {amplitude: 25, frequency: 50.03, taxel_time: 2.0e-3}\n"));
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "mains_pickup");
  EXPECT_NEAR(valueOf(report, "amplitude"), 25, 5);
  EXPECT_NEAR(valueOf(report, "frequency"), 50.03, 0.1);
  EXPECT_TRUE(std::isnan(report.gap.closed)) << "no simulation has its phase";
  ASSERT_FALSE(report.gap.missing.empty());
  EXPECT_NE(report.gap.missing.back().find("random"), std::string::npos);
}

// The break-in closes less than `second_adds` of what the loop leaves to close, but it lies in what changes
// from cycle to cycle, where the loop shows nothing.
TEST(Investigate, NamesASlowEffectBesideAFastOne) {
  const DiscrepancyReport report =
      investigate(planted(kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n  break_in: {change: -0.07}\n"));
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.at(0), (std::vector<std::string>{"hysteresis", "break_in"}))
      << report.sentence;
  EXPECT_LT(report.gap.after, report.gap.before);
}

TEST(Investigate, SaysWhichTaxelsAreOddWhereNoFaultIsInTheLibrary) {
  DiscrepancyProblem row = planted(kTwoSpeeds, "  row_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n");
  row.options.leave_out = {"row_fault", "stuck_taxel", "dead_taxel"};
  const DiscrepancyReport by_row = answerTo(row);
  ASSERT_EQ(by_row.verdict, Verdict::kUnknown) << by_row.sentence;
  EXPECT_EQ(by_row.depends_on, std::vector<std::string>{"row"});
  EXPECT_EQ(by_row.where.taxels, (std::vector<std::size_t>{4, 5, 6, 7}));
  DiscrepancyProblem dead = planted(kTwoSpeeds, "  dead_taxel: {taxels: 1, first: 5, start: 700}\n");
  dead.options.leave_out = {"dead_taxel", "stuck_taxel"};
  EXPECT_EQ(answerTo(dead).verdict, Verdict::kUnknown);
}

// From mount to mount a room may be warmer, too. What is random is in neither simulation of the gap.
TEST(Investigate, IsAmbiguousBetweenMountsAndTheRoomWithoutAThermometer) {
  std::string rig = kTwoSpeeds;
  rig.insert(rig.find("effects:"),
             "  - {surface: flat, flat: true, pause: 300}\n  - {surface: flat, flat: true, pause: 300}\n");
  const std::string room = "climate: {room: [{time: 0, temperature: 23}]}\n";
  for (const bool thermometer : {true, false}) {
    DiscrepancyProblem problem = planted(rig, "  repositioning: {offset: 8000, gain: 0.05}\n" + room);
    if (!thermometer) {
      for (fsr::dataset::Recording& recording : problem.recordings) recording.temperature.clear();
    }
    const DiscrepancyReport report = answerTo(problem);
    EXPECT_EQ(report.verdict, thermometer ? Verdict::kNamed : Verdict::kAmbiguous) << report.sentence;
    EXPECT_EQ(report.credible_set.at(0), std::vector<std::string>{"repositioning"}) << report.sentence;
    EXPECT_EQ(report.gap.after, report.gap.before);
    if (thermometer) continue;
    EXPECT_EQ(report.credible_set.at(1), std::vector<std::string>{"temperature"});
    ASSERT_FALSE(report.next_experiment.empty());
    EXPECT_EQ(report.next_experiment[0].protocol, "two_ambients");
  }
}

// One speed cannot distinguish a loop from a short memory. The recommended experiment can. The prediction
// that was made before it passes for the true effect and fails for the other.
TEST(Investigate, RecommendsAnExperimentThatSettlesIt) {
  const std::string loop = "  hysteresis: {loop_width: 0.05}\n";
  DiscrepancyProblem problem = planted(kOneSpeed, loop);
  const DiscrepancyReport before = answerTo(problem);
  ASSERT_EQ(before.verdict, Verdict::kAmbiguous);
  ASSERT_EQ(before.next_experiment.size(), 1u);
  EXPECT_GE(before.next_experiment.front().cycles, 5);
  const std::vector<std::string> with_two_speeds = {"two_speeds", "step_hold", "random_order"};
  EXPECT_EQ(std::count(with_two_speeds.begin(), with_two_speeds.end(), before.next_experiment[0].protocol),
            1);

  fsr::simulation::SimulationSettings rig =
      fsr::discrepancy::runProtocol(before.next_experiment[0].protocol, simulation(kOneSpeed, loop), 620e3);
  rig.seed = 11;
  rig.start += 86400;
  const std::vector<fsr::simulation::Station> once = rig.session;
  rig.session.insert(rig.session.end(), once.begin(), once.end());
  const std::vector<fsr::dataset::Recording> experiment = fsr::simulation::simulateSession(rig);
  EXPECT_TRUE(confirm(before.prediction, before.base, experiment).passed);
  fsr::discrepancy::Prediction wrong = before.prediction;
  std::swap(wrong.effects, wrong.rivals.at(0));
  wrong.spread = {};  // of the other effect
  EXPECT_THROW(confirm(wrong, before.base, experiment), fsr::settings::InputError)
      << "it was changed afterwards";
  wrong.hash = hashOf(wrong, before.base);
  EXPECT_FALSE(confirm(wrong, before.base, experiment).passed);

  problem.recordings.insert(problem.recordings.end(), experiment.begin(), experiment.end());
  const DiscrepancyReport after = investigate(problem);
  ASSERT_EQ(after.verdict, Verdict::kNamed) << after.sentence;
  EXPECT_EQ(after.effects.at(0).id, "hysteresis");
}

// In the hold-out cycles the loop is the other way round.
TEST(Investigate, NamesNoEffectThatMakesTheGapLarger) {
  DiscrepancyProblem problem = planted(kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n");
  const DiscrepancyReport named = answerTo(problem);
  ASSERT_EQ(named.verdict, Verdict::kNamed) << named.sentence;
  const auto isHeldOut = [&](const fsr::dataset::Recording& recording, std::size_t scan) {
    const std::int64_t stamp = recording.start_ns + std::llround(1e9 * recording.time[scan]);
    const auto holds = [&](const auto& span) { return stamp >= span.first && stamp <= span.second; };
    return std::any_of(named.hold_out.begin(), named.hold_out.end(), [&](const auto& held) {
      return held.file == recording.name && std::any_of(held.cycles.begin(), held.cycles.end(), holds);
    });
  };
  const DiscrepancyProblem without = planted(kTwoSpeeds, "");
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    fsr::dataset::Recording& recording = problem.recordings[r];
    const std::size_t taxels = recording.layout.size.taxels();
    for (std::size_t i = 0; i < recording.counts.size(); ++i) {
      std::uint16_t& count = recording.counts[i];
      if (isHeldOut(recording, i / taxels))
        count = static_cast<std::uint16_t>(2 * without.recordings[r].counts[i] - count);
    }
  }
  const DiscrepancyReport report = investigate(problem);
  EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
  EXPECT_TRUE(report.credible_set.empty());
  EXPECT_TRUE(report.effects.empty());
  EXPECT_EQ(report.gap.after, report.gap.before);
  EXPECT_EQ(report.depends_on, named.depends_on);
  const auto told = [](const std::string& text) { return text.find("hysteresis") != std::string::npos; };
  EXPECT_TRUE(std::any_of(report.limitations.begin(), report.limitations.end(), told)) << "the best guess";
}

TEST(Investigate, IsTheSameOnThreeThreads) {
  DiscrepancyProblem problem =
      planted(fsr::discrepancy::planted::kOneSurface, "  hysteresis: {loop_width: 0.05}\n");
  const DiscrepancyReport on_one = answerTo(problem);
  ASSERT_NE(on_one.verdict, Verdict::kNone) << "contenders are fitted";
  problem.options.threads = 3;
  const DiscrepancyReport on_three = investigate(problem);
  EXPECT_EQ(on_three.sentence, on_one.sentence);
  EXPECT_EQ(on_three.gap.after, on_one.gap.after);
  ASSERT_EQ(on_three.candidates.size(), on_one.candidates.size());
  for (std::size_t i = 0; i < on_one.candidates.size(); ++i)
    EXPECT_EQ(on_three.candidates[i].z, on_one.candidates[i].z);
}

TEST(Investigate, StartsFromWhatTheSimulationHasAlready) {
  const std::string loop = "  hysteresis: {loop_width: 0.05}\n";
  DiscrepancyProblem problem = planted(kTwoSpeeds, loop + "  time_skew: {delay: 0.25}\n");
  problem.simulation = simulation(kTwoSpeeds, "  hysteresis: {loop_width: 0.03}\n");
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.credible_set.at(0), std::vector<std::string>{"time_skew"});
  EXPECT_NEAR(report.base.effect("hysteresis")->values.at("loop_width"), 0.05, 0.005) << "sized together";
  problem.recordings = fsr::simulation::simulateSession(simulation(kTwoSpeeds, loop));
  const DiscrepancyReport quiet = investigate(problem);
  EXPECT_EQ(quiet.verdict, Verdict::kNone) << quiet.sentence;
}

TEST(Investigate, NamesALateClockAndByHowMuchAndRepeatsUntilQuiet) {
  DiscrepancyProblem problem = planted(kTwoSpeeds, "  time_skew: {delay: 0.25}\n");
  const DiscrepancyReport once = answerTo(problem);
  ASSERT_EQ(once.verdict, Verdict::kNamed) << once.sentence;
  EXPECT_EQ(once.effects.at(0).id, "time_skew");
  EXPECT_NEAR(valueOf(once, "delay"), 0.25, 0.02);
  problem.options.repeat = true;
  const DiscrepancyReport report = answerTo(problem);
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  ASSERT_EQ(report.steps.size(), 2u);
  EXPECT_EQ(report.steps[0].added, "time_skew");
  EXPECT_TRUE(report.steps[1].added.empty());
  EXPECT_EQ(report.gap.before, once.gap.before);
  EXPECT_EQ(report.gap.floor, once.gap.floor);
  EXPECT_NEAR(report.gap.floor, kNoise, 0.15 * kNoise) << "that of the readings as they were recorded";
  EXPECT_NE(report.gap.floor, report.gap.after);
  EXPECT_GT(report.gap.closed, 0.9);
  EXPECT_EQ(report.credible_set, (std::vector<Ids>{{"time_skew"}}));
}

std::string refusal(const DiscrepancyProblem& problem) {
  return test_support::refusal([&] { investigate(problem); });
}

TEST(Investigate, RefusesWhatCannotBeJudged) {
  const DiscrepancyProblem good = planted(kOneSpeed, "");
  DiscrepancyProblem bad = good;
  bad.recordings.clear();
  EXPECT_NE(refusal(bad).find("no bag"), std::string::npos);
  bad = good;
  bad.recordings[1].pressure.clear();
  EXPECT_NE(refusal(bad).find("2_cylinder_5cm.bag: no chamber pressure"), std::string::npos);
  bad = good;
  std::swap(bad.recordings[0].time[10], bad.recordings[0].time[11]);
  EXPECT_NE(refusal(bad).find("stamps run backwards"), std::string::npos);
  bad = good;
  bad.simulation.layout.size = {7, 10};
  EXPECT_NE(refusal(bad).find("matrix is 7 x 10"), std::string::npos);
  bad = good;
  for (double& p : bad.recordings[0].pressure) p *= 0.01;
  bad.recordings.resize(1);
  EXPECT_NE(refusal(bad).find("at least 10 kPa"), std::string::npos) << refusal(bad);
  bad = good;
  for (double& p : bad.recordings[1].pressure) p *= 1e-3;
  EXPECT_TRUE(test_support::holds(refusal(bad), {"2_cylinder_5cm.bag: chamber pressure covers 0.6",
                                                 "readings change as if it were much more"}));
  bad = good;
  for (std::uint16_t& count : bad.recordings[1].counts) count = static_cast<std::uint16_t>(4095 - count);
  EXPECT_TRUE(test_support::holds(refusal(bad), {"2_cylinder_5cm.bag: its readings fall while"}));
  bad = good;  // its clock is a third of a cycle late
  std::rotate(bad.recordings[1].pressure.begin(), bad.recordings[1].pressure.begin() + 70,
              bad.recordings[1].pressure.end());
  EXPECT_TRUE(test_support::holds(refusal(bad),
                                  {"2_cylinder_5cm.bag: its readings do not follow the chamber pressure"}));
  bad = good;
  bad.recordings[0].mask.assign(12, 1);
  EXPECT_NE(refusal(bad).find("at least half must be usable"), std::string::npos);
  bad = good;
  bad.options.ask = {"gremlins"};
  EXPECT_NE(refusal(bad).find("no effect is called gremlins"), std::string::npos);
}

TEST(Investigate, RefusesASingleCycle) {
  std::string once = kOneSpeed;
  once.replace(once.find("cycles: 8"), 9, "cycles: 1");
  EXPECT_NE(refusal(planted(once, "")).find("at least 3 are needed"), std::string::npos);
}

}  // namespace
