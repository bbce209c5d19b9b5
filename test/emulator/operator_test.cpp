#include "emulator/operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace {

using fsr::emulator::Act;
using fsr::emulator::Habits;
using fsr::emulator::Operator;
using fsr::emulator::OperatorOptions;
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

OperatorOptions exact() {
  OperatorOptions options;
  options.habits = Habits::exact();
  options.habits.change_least = options.habits.change_most = kChange;
  return options;
}

/// An operator who gets one instruction after the other, each when the one before is done.
class Day {
 public:
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
  Operator person{exact()};
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
  EXPECT_EQ(test_support::refusal([&] { person.instruct(0, wrong); }),
            "instruction of step 11 (cycle): peak is 900000, but must be 0 to 793000 Pa gauge (the chamber "
            "is rated at 793 kPa)");
  wrong = cycle(1);
  wrong.rate = std::nan("");
  EXPECT_THROW(person.instruct(0, wrong), fsr::settings::InputError);
  wrong = mount("");
  EXPECT_THROW(person.instruct(0, wrong), fsr::settings::InputError);
  EXPECT_EQ(person.gaugePressure(30), 0);
}

}  // namespace
