#include "emulator/operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fsr_pressure_map/settings/input_error.h"

namespace {

using fsr::emulator::Act;
using fsr::emulator::Habits;
using fsr::emulator::mistakes;
using fsr::emulator::Operator;
using fsr::emulator::OperatorOptions;
using fsr::emulator::readMistakes;
using fsr::emulator::Task;
using fsr::emulator::TaskKind;

constexpr double kPeak = 400e3;  // [Pa]
constexpr double kRate = 20e3;   // [Pa/s]
constexpr double kChange = 25;   // to put the sheet on [s]

Task task(TaskKind kind, std::uint32_t step) {
  Task result;
  result.kind = kind;
  result.step = step;
  result.surface = "cylinder_7cm";
  result.mount = 1;
  result.rate = kRate;
  return result;
}

// 5 s rest, 20 s up, 8 s dwell, 20 s down.
Task cycle(std::uint32_t number, std::uint32_t of = 3) {
  Task result = task(TaskKind::kCycle, 10 + number);
  result.cycle = number;
  result.cycles = of;
  result.peak = kPeak;
  result.dwell_peak = 8;
  result.dwell_rest = 5;
  return result;
}

Task mount(const std::string& surface = "cylinder_7cm", std::uint32_t number = 1) {
  Task result = task(TaskKind::kMount, number);
  result.surface = surface;
  result.mount = number;
  result.confirm = true;
  return result;
}

Task rest(double length) {
  Task result = task(TaskKind::kRest, 30);
  result.dwell_rest = length;
  return result;
}

Task hold(double length) {
  Task result = task(TaskKind::kHold, 40);
  result.peak = kPeak;
  result.dwell_peak = length;
  return result;
}

Task loop() {
  Task result = task(TaskKind::kLoop, 50);
  result.low = 100e3;
  result.cycle = 1;
  result.cycles = 2;
  result.peak = kPeak;
  return result;
}

Task again(Task task, const std::string& remark) {
  task.remark = "last attempt rejected: " + remark;
  return task;
}

OperatorOptions exact(const std::string& script = "") {
  OperatorOptions options;
  options.mistakes = readMistakes(script);
  options.shelf = {"flat", "cylinder_5cm", "cylinder_7cm"};
  options.habits = Habits::exact();
  options.habits.change_least = options.habits.change_most = kChange;
  return options;
}

/// An operator who gets one instruction after the other, each when the one before is done.
class Day {
 public:
  explicit Day(const std::string& script = "") : person(exact(script)) {}

  /// Gives an instruction and lets it be done. Returns its begin.
  double give(const Task& task) {
    const double begin = now;
    person.instruct(now, task);
    until(person.doneAt());
    return begin;
  }
  void until(double time) {
    now = std::max(now, time);
    for (const Act& act : person.takeActs(now)) acts.push_back(act);
  }
  /// "25 put on flat" ...: what was done, with the times since `begin` rounded to seconds.
  std::vector<std::string> done(double begin = 0) const {
    std::vector<std::string> result;
    for (const Act& act : acts) {
      if (act.time < begin) continue;
      result.push_back(std::to_string(std::lround(act.time - begin)) + " " + describe(act));
    }
    return result;
  }
  double highest(double from, double to) const {
    double result = 0;
    for (double t = from; t <= to; t += 0.1) result = std::max(result, person.gaugePressure(t));
    return result;
  }
  /// Time within 1 % of a pressure [s].
  double dwell(double pressure, double from, double to) const {
    double result = 0;
    for (double t = from; t <= to; t += 0.1) {
      result += std::abs(person.gaugePressure(t) - pressure) < 0.01 * pressure ? 0.1 : 0;
    }
    return result;
  }

  Operator person;
  std::vector<Act> acts;
  double now = 0;
};

std::vector<std::string> list(std::initializer_list<std::string> texts) {
  return texts;
}

// --- without mistakes ------------------------------------------------------------------------------

TEST(Operator, DoesACycleAsItIsAskedFor) {
  Day day;
  const double begin = day.give(cycle(1));
  EXPECT_EQ(day.person.gaugePressure(begin + 4.9), 0);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin + 15), 200e3);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin + 25), kPeak);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin + 33), kPeak);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin + 43), 200e3);
  EXPECT_DOUBLE_EQ(day.person.doneAt(), begin + 53);
  EXPECT_TRUE(day.acts.empty());
}

TEST(Operator, PutsTheSheetOnAndConfirms) {
  Day day;
  day.person.instruct(0, hold(10));
  day.until(30);
  const double begin = day.give(mount());
  // Vents from 400 kPa first.
  EXPECT_EQ(day.done(begin),
            list({"20 take the sheet off", "45 put the sheet on cylinder_7cm", "45 confirm"}));
}

TEST(Operator, HoldsAPressureUntilTheNextInstruction) {
  Day day;
  day.give(hold(60));
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 80);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(500), kPeak);
  day.give(rest(30));
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(90), 200e3);
  EXPECT_EQ(day.person.gaugePressure(110), 0);
}

TEST(Operator, DoesALoopBetweenItsPressures) {
  Day day;
  day.give(loop());
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(5), 100e3);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(20), kPeak);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(35), 100e3);
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 35);
}

TEST(Operator, IgnoresAnInstructionThatIsRepeatedMeanwhile) {
  Day day;
  day.person.instruct(0, cycle(1));
  for (double time = 1; time < 50; time += 1) day.person.instruct(time, cycle(1));
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 53);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(30), kPeak);
}

TEST(Operator, VentsAndBeginsAgainWhenAnAttemptIsRejected) {
  Day day;
  day.person.instruct(0, cycle(1));
  day.person.instruct(15, again(cycle(1), "too fast"));  // at 200 kPa
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(14), 180e3) << "the past does not change";
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(20), 100e3);
  EXPECT_EQ(day.person.gaugePressure(25), 0);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(50), kPeak);
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 25 + 53);
}

TEST(Operator, BeginsAHoldFromRestAfterARejection) {
  Day day;
  day.give(hold(60));
  const double begin = day.give(again(hold(60), "leak"));
  EXPECT_EQ(day.person.gaugePressure(begin + 21), 0);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin + 43), kPeak);
}

TEST(Operator, GoesOnWhenARemarkOnlySaysWhatHinders) {
  Day day("board_unplugged");
  Task told = cycle(1);
  day.person.instruct(0, told);
  told.remark = "no scan came for 2 s";
  day.person.instruct(17, told);
  told.remark = "";
  day.person.instruct(19, told);
  day.until(100);
  EXPECT_EQ(day.done(), list({"15 unplug the board", "17 plug the board in"}));
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 53);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(30), kPeak);
}

TEST(Operator, PressesAgainWhenNobodyAcceptsIt) {
  Day day;
  day.give(cycle(1));
  day.until(53 + 119);
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 53);
  day.until(53 + 121);
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 53 + 121 + 53);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(53 + 121 + 30), kPeak);
}

TEST(Operator, NeverBeginsATaskThatIsReplacedAtOnce) {
  OperatorOptions options = exact();
  options.habits.reaction_least = options.habits.reaction_most = 2;
  Operator person(options);
  person.instruct(0, hold(60));
  person.instruct(1, rest(10));
  for (double time = 0; time < 100; time += 1) EXPECT_EQ(person.gaugePressure(time), 0);
}

TEST(Operator, GivesUpAMountingForAnotherSurface) {
  Day day;
  day.person.instruct(0, mount("cylinder_5cm", 1));
  day.until(10);
  day.give(mount("cylinder_7cm", 2));
  EXPECT_EQ(day.done(), list({"0 take the sheet off", "10 take the sheet off",
                              "35 put the sheet on cylinder_7cm", "35 confirm"}));
}

TEST(Operator, ConfirmsAgainWithoutMountingWhereTheSheetLiesRight) {
  Day day;
  day.give(mount());
  const double begin = day.give(again(mount(), "not confirmed"));
  EXPECT_EQ(day.done(begin + 0.1).size(), 0u);
  EXPECT_EQ(day.acts.back().time, begin);
  EXPECT_EQ(day.acts.back().kind, Act::Kind::kConfirm);
}

TEST(Operator, NumbersEachPuttingOnAnew) {
  Day day("turned_over@1");
  day.give(mount("flat", 7));
  day.give(again(mount("flat", 7), "the sheet is turned over"));
  std::vector<std::uint32_t> numbers;
  for (const Act& act : day.acts) {
    if (act.kind == Act::Kind::kPutOn) numbers.push_back(act.mount);
  }
  EXPECT_EQ(numbers, (std::vector<std::uint32_t>{7, 10007}));
}

TEST(Operator, IsUnevenWithinItsHabitsAndReproducible) {
  OperatorOptions options;
  options.seed = 3;
  Operator person(options), twin(options);
  options.seed = 4;
  Operator other(options);
  for (Operator* one : {&person, &twin, &other}) one->instruct(0, cycle(1));
  double highest = 0, difference = 0;
  for (double time = 0; time < 60; time += 0.5) {
    EXPECT_EQ(person.gaugePressure(time), twin.gaugePressure(time));
    difference += std::abs(person.gaugePressure(time) - other.gaugePressure(time));
    highest = std::max(highest, person.gaugePressure(time));
  }
  EXPECT_GT(difference, 0);
  EXPECT_NEAR(highest, kPeak, 0.0101 * kPeak);
  EXPECT_NE(highest, kPeak);
}

TEST(Operator, RefusesNumbersThatNoChamberReaches) {
  Operator person(exact());
  Task wrong = cycle(1);
  wrong.peak = 900e3;
  try {
    person.instruct(0, wrong);
    FAIL();
  } catch (const fsr::settings::InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "instruction of step 11 (cycle): peak is 900000, but must be 0 to 793000 Pa gauge (the chamber "
        "is rated at 793 kPa)");
  }
  wrong = cycle(1);
  wrong.rate = std::nan("");
  EXPECT_THROW(person.instruct(0, wrong), fsr::settings::InputError);
  wrong = mount("");
  EXPECT_THROW(person.instruct(0, wrong), fsr::settings::InputError);
  EXPECT_EQ(person.gaugePressure(30), 0);
}

// --- mistakes --------------------------------------------------------------------------------------

TEST(OperatorMistakes, AreTwentyOrMoreWithTextsAndNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const auto& mistake : mistakes()) {
    names.insert(mistake.name);
    EXPECT_FALSE(mistake.description.empty()) << mistake.name;
    EXPECT_EQ(mistake.expected.empty(), mistake.notice == fsr::emulator::Notice::kWaiting) << mistake.name;
    EXPECT_EQ(mistake.change != nullptr, mistake.slip == fsr::emulator::Slip::kNumbers) << mistake.name;
  }
  EXPECT_EQ(names.size(), mistakes().size());
  EXPECT_GE(names.size(), 20u);
}

TEST(OperatorMistakes, AreReadFromAScript) {
  const auto script = readMistakes("peak_too_low@5, leak");
  ASSERT_EQ(script.size(), 2u);
  EXPECT_EQ(script[0].name, "peak_too_low");
  EXPECT_EQ(script[0].step, 5u);
  EXPECT_EQ(script[1].name, "leak");
  EXPECT_EQ(script[1].step, 0u);
  EXPECT_TRUE(readMistakes("").empty());
}

TEST(OperatorMistakes, RefuseAScriptThatCannotBeRead) {
  EXPECT_THROW(readMistakes("peak_too_low@five"), fsr::settings::InputError);
  EXPECT_THROW(readMistakes("peak_too_low@5x"), fsr::settings::InputError);
  EXPECT_THROW(readMistakes("peak_too_low@"), fsr::settings::InputError);
  try {
    readMistakes("sneeze@1");
    FAIL();
  } catch (const fsr::settings::InputError& error) {
    EXPECT_EQ(std::string(error.what())
                  .rfind("mistakes: there is no mistake \"sneeze\"; there are skip_surface,", 0),
              0u);
  }
  OperatorOptions bare = exact("skip_surface");
  bare.shelf.resize(1);
  EXPECT_THROW(Operator{bare}, fsr::settings::InputError);
}

// Each mistake changes what a session looks like, is made once, and is over at the next attempt.
TEST(OperatorMistakes, AreMadeOnceAndChangeTheSession) {
  const auto session = [](Day& day) {
    std::vector<double> pressures;
    Task further = loop();
    further.cycle = 2;
    const std::vector<Task> tasks = {mount(),           further,  task(TaskKind::kCondition, 5),
                                     cycle(1),          cycle(2), cycle(3),
                                     hold(60),          loop(),   rest(60),
                                     mount("flat", 60), rest(30)};
    for (const Task& one : tasks) {
      const double begin = day.give(one);
      day.until(day.now + 20);
      day.give(again(one, "again"));
      for (double time = begin; time < day.now; time += 1)
        pressures.push_back(day.person.gaugePressure(time));
    }
    return pressures;
  };
  Day faultless;
  const std::vector<double> right = session(faultless);
  for (const auto& mistake : mistakes()) {
    Day day(mistake.name);
    const std::vector<double> pressures = session(day);
    ASSERT_EQ(day.person.made().size(), 1u) << mistake.name;
    EXPECT_EQ(day.person.made().front().name, mistake.name);
    EXPECT_TRUE(day.person.pending().empty()) << mistake.name;
    EXPECT_TRUE(pressures != right || day.done() != faultless.done()) << mistake.name;
  }
}

TEST(OperatorMistakes, WaitForAStepThatTheySuit) {
  Day day("leak@12,peak_too_low@900");
  day.give(cycle(1));
  EXPECT_TRUE(day.person.made().empty());
  day.give(mount());
  day.give(cycle(3));
  ASSERT_EQ(day.person.made().size(), 1u);
  EXPECT_EQ(day.person.made().front().step, 13u);
  EXPECT_EQ(day.person.pending(), list({"peak_too_low"}));
}

TEST(OperatorMistakes, SkipSurface) {
  Day day("skip_surface");
  day.give(mount("flat"));
  EXPECT_EQ(day.done(), list({"0 take the sheet off", "25 put the sheet on cylinder_5cm", "25 confirm"}));
  const double begin = day.give(again(mount("flat"), "other surface"));
  EXPECT_EQ(day.done(begin).back(), "25 confirm");
  EXPECT_EQ(day.acts[day.acts.size() - 2].surface, "flat");
}

TEST(OperatorMistakes, SwapSurfaces) {
  Day day("swap_surfaces");
  day.give(mount("flat", 1));
  day.give(mount("cylinder_5cm", 2));
  day.give(mount("cylinder_7cm", 3));
  std::vector<std::string> surfaces;
  for (const Act& act : day.acts) {
    if (act.kind == Act::Kind::kPutOn) surfaces.push_back(act.surface);
  }
  EXPECT_EQ(surfaces, list({"cylinder_5cm", "flat", "cylinder_7cm"}));
}

TEST(OperatorMistakes, RepeatSurface) {
  Day day("repeat_surface@2");
  day.give(mount("cylinder_5cm", 1));
  const double begin = day.give(mount("cylinder_7cm", 2));
  EXPECT_EQ(day.done(begin + 0.1), list({"25 put the sheet on cylinder_5cm", "25 confirm"}));
}

TEST(OperatorMistakes, WrongSurfaceAfterTheRightOneWasConfirmed) {
  Day day("wrong_surface_later");
  day.give(mount("flat"));
  day.person.instruct(30, rest(30));
  day.until(100);
  EXPECT_EQ(day.done(), list({"0 take the sheet off", "25 put the sheet on flat", "25 confirm",
                              "26 take the sheet off", "51 put the sheet on cylinder_5cm"}));
  const double begin = day.give(again(cycle(1), "other surface under the sheet"));
  EXPECT_EQ(day.done(begin), list({"0 take the sheet off", "25 put the sheet on flat"}));
}

TEST(OperatorMistakes, TurnedOver) {
  Day day("turned_over");
  day.give(mount("flat"));
  EXPECT_EQ(day.done()[1], "25 put the sheet on flat, turned over");
  day.give(again(mount("flat"), "the sheet is turned over"));
  EXPECT_FALSE(day.acts[day.acts.size() - 2].turned_over);
}

TEST(OperatorMistakes, ConfirmWithoutMounting) {
  Day day("confirm_without_mounting");
  day.give(mount());
  EXPECT_EQ(day.done(), list({"0 confirm"}));
}

TEST(OperatorMistakes, ForgetConfirming) {
  Day day("forget_confirming");
  day.person.instruct(0, mount());
  day.until(100);
  EXPECT_EQ(day.done().size(), 2u);
  const double begin = day.give(again(mount(), "not confirmed"));
  EXPECT_EQ(day.done(begin), list({"0 confirm"}));
  day.until(1000);
  EXPECT_EQ(day.acts.size(), 3u) << "confirms once";
}

TEST(OperatorMistakes, PressBeforeConfirming) {
  Day day("press_before_confirming");
  day.give(mount());
  ASSERT_EQ(day.done().size(), 3u);
  EXPECT_EQ(day.acts[2].kind, Act::Kind::kConfirm);
  EXPECT_GE(day.highest(kChange, day.acts[2].time), 99e3);
}

TEST(OperatorMistakes, ForgetConditioning) {
  Day day("forget_conditioning");
  Task conditioning = cycle(1);
  conditioning.kind = TaskKind::kCondition;
  day.person.instruct(0, conditioning);
  EXPECT_EQ(day.highest(0, 120), 0);
  EXPECT_EQ(day.highest(120, 180), kPeak) << "notices it at last";
}

TEST(OperatorMistakes, ForgetRest) {
  Day day("forget_rest");
  day.give(cycle(1));
  const double begin = day.give(rest(60));
  EXPECT_EQ(day.highest(begin, begin + 60), kPeak);
}

TEST(OperatorMistakes, SkipCycle) {
  Day day("skip_cycle@12");
  day.give(cycle(1));
  const double begin = day.now;
  day.person.instruct(begin, cycle(2));
  EXPECT_EQ(day.highest(begin + 1, begin + 120), 0);
  day.person.instruct(begin + 60, again(cycle(2), "nothing done"));
  EXPECT_EQ(day.highest(begin + 60, begin + 90), kPeak);
}

TEST(OperatorMistakes, ExtraCycle) {
  Day day("extra_cycle");
  day.give(cycle(1));
  day.person.instruct(53, cycle(3));
  day.person.instruct(53 + 53, rest(30));  // the operator does not look
  EXPECT_EQ(day.highest(53 + 54, 53 + 100), kPeak);
  EXPECT_DOUBLE_EQ(day.person.doneAt(), 53 * 3 + 30);
}

TEST(OperatorMistakes, StopHalfway) {
  Day day("stop_halfway");
  day.give(cycle(1));
  EXPECT_NEAR(day.highest(0, 100), kPeak / 2, 2e3);
  EXPECT_EQ(day.person.gaugePressure(day.now), 0);
}

TEST(OperatorMistakes, PeakTooLowAndTooHigh) {
  Day low("peak_too_low"), high("peak_too_high"), held("peak_too_low");
  low.give(cycle(1));
  high.give(cycle(1));
  held.give(hold(60));
  EXPECT_DOUBLE_EQ(low.highest(0, 100), 0.8 * kPeak);
  EXPECT_DOUBLE_EQ(high.highest(0, 100), 1.15 * kPeak);
  EXPECT_DOUBLE_EQ(held.highest(0, 100), 0.8 * kPeak);
}

TEST(OperatorMistakes, TooFastAndTooSlow) {
  Day fast("too_fast"), slow("too_slow");
  fast.give(cycle(1));
  slow.give(cycle(1));
  EXPECT_DOUBLE_EQ(fast.now, 5 + 10 + 8 + 10);
  EXPECT_DOUBLE_EQ(slow.now, 5 + 50 + 8 + 50);
}

TEST(OperatorMistakes, DwellTooShortAndTooLong) {
  Day brief("dwell_too_short"), late("dwell_too_long"), held("dwell_too_short");
  brief.give(cycle(1));
  late.give(cycle(1));
  EXPECT_NEAR(brief.dwell(kPeak, 0, brief.now), 1.6, 0.6);
  EXPECT_NEAR(late.dwell(kPeak, 0, late.now), 23, 0.6);
  held.give(hold(60));
  EXPECT_NEAR(held.dwell(kPeak, 0, held.now), 12, 0.6);
}

TEST(OperatorMistakes, Leak) {
  Day day("leak");
  day.give(hold(60));
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(20), kPeak);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(50), 0.9 * kPeak);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(80), 0.8 * kPeak);
}

TEST(OperatorMistakes, NoUnloading) {
  Day day("no_unloading");
  day.give(cycle(1));
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(day.now + 100), kPeak / 2);
  day.now += 100;
  const double begin = day.give(again(cycle(1), "no unloading"));
  EXPECT_EQ(day.person.gaugePressure(begin + 10), 0);
}

TEST(OperatorMistakes, NoUnloadingIsPutRightAtAHint) {
  Day day("no_unloading");
  Task told = cycle(1);
  day.give(told);
  told.remark = "the pressure stays at 200 kPa";
  day.person.instruct(day.now + 5, told);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(day.now + 10), 100e3);
  EXPECT_EQ(day.person.gaugePressure(day.now + 15), 0);
}

TEST(OperatorMistakes, PauseInCycle) {
  Day day("pause_in_cycle");
  day.give(cycle(1));
  EXPECT_NEAR(day.dwell(kPeak / 2, 0, 60), 30, 1);
  EXPECT_DOUBLE_EQ(day.now, 53 + 30);
}

TEST(OperatorMistakes, ValveOpened) {
  Day day("valve_opened");
  day.give(cycle(1));
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(5 + 12), 0.6 * kPeak);
  EXPECT_NEAR(day.person.gaugePressure(5 + 12.8), 0.2 * kPeak, 1);
  EXPECT_DOUBLE_EQ(day.highest(0, 100), kPeak);
}

TEST(OperatorMistakes, LoopToZero) {
  Day day("loop_to_zero");
  day.give(loop());
  Task second = loop();
  second.cycle = 2;
  const double begin = day.give(second);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin), 100e3);
  EXPECT_EQ(day.person.gaugePressure(begin + 5), 0);
  EXPECT_DOUBLE_EQ(day.person.gaugePressure(begin + 25), kPeak);
  EXPECT_EQ(day.person.gaugePressure(begin + 45), 0);
}

TEST(OperatorMistakes, SheetOffIsPutRightAtARemark) {
  Day day("sheet_off");
  day.give(mount("flat"));
  double begin = day.give(cycle(1));
  EXPECT_EQ(day.done(begin + 0.1), list({"15 take the sheet off"}));
  begin = day.give(again(cycle(1), "no load on any taxel"));
  EXPECT_EQ(day.done(begin), list({"0 take the sheet off", "25 put the sheet on flat"}));
  EXPECT_DOUBLE_EQ(day.now, begin + kChange + 53);
}

TEST(OperatorMistakes, TaxelOutIsPutRightAtARemark) {
  Day day("taxel_out");
  double begin = day.give(cycle(1));
  EXPECT_EQ(day.done(begin), list({"15 pull at the cable of the sheet"}));
  EXPECT_GT(day.acts.back().pick, 0);
  EXPECT_LT(day.acts.back().pick, 1);
  begin = day.give(again(cycle(1), "a taxel fell out"));
  EXPECT_EQ(day.done(begin), list({"0 press the connector of the sheet down"}));
}

TEST(OperatorMistakes, UnpluggedThingsArePluggedInAtARemarkOrAfterAWhile) {
  const std::vector<std::vector<std::string>> cases = {
      {"board_unplugged", "unplug the board", "plug the board in"},
      {"transducer_unplugged", "unplug the transducer", "plug the transducer in"},
      {"transducer_silent", "switch the transducer off", "plug the transducer in"}};
  for (const auto& one : cases) {
    Day told(one[0]), alone(one[0]);
    told.person.instruct(0, cycle(1));
    told.until(20);
    told.give(again(cycle(1), "lost"));
    EXPECT_EQ(told.done(), list({"15 " + one[1], "20 " + one[2]}));
    alone.give(cycle(1));
    EXPECT_EQ(alone.done(), list({"15 " + one[1], "45 " + one[2]}));
    EXPECT_EQ(alone.highest(0, 60), kPeak) << "the cycle goes on";
  }
}

TEST(OperatorMistakes, TerminalClosed) {
  Day day("terminal_closed");
  const double begin = day.give(cycle(1));
  EXPECT_EQ(day.done(begin), list({"15 close the terminal of the conductor"}));
  EXPECT_DOUBLE_EQ(day.now, begin + 53) << "the cycle goes on";
}

}  // namespace
