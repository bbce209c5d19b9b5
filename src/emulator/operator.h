#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/board.h"
#include "emulator/line_damage.h"
#include "simulation/pressure_profile.h"
#include "statistics/random_stream.h"

namespace fsr::emulator {

/// Gauge pressure over rig time that is written piece by piece while it is read: linear between its points,
/// 0 before the first one, constant after the last one.
class PressureCourse {
 public:
  /// Forgets everything from `time` [s] on. The pressure of that time stays. Times before it do not change.
  void cut(double time);
  /// Appends a straight piece to `pressure` [Pa gauge], at `rate` [Pa/s] or within `duration` [s].
  void rampTo(double pressure, double rate);
  void moveTo(double pressure, double duration);
  /// Appends a piece of constant pressure [s].
  void stay(double duration) { moveTo(pressure(), duration); }

  /// End of what is written [s] and the pressure there [Pa].
  double end() const { return points_.back().time; }
  double pressure() const { return points_.back().pressure; }
  /// Pressure at any time [Pa].
  double at(double time) const;

 private:
  std::vector<simulation::PressurePoint> points_{{0, 0}};  // by ascending time
};

/// What the operator is asked to do. The values are those of msg/Instruction.msg.
enum class TaskKind : std::uint8_t {
  kCondition,  ///< a cycle of the conditioning
  kMount,      ///< put the sheet on a surface
  kRest,       ///< no load
  kCycle,      ///< rest, fill, dwell, vent
  kLoop,       ///< a partial loop from `low` to `peak` and back
  kHold,       ///< go to a pressure and hold it
  kBreak,      ///< a long pause without load
  kDone,       ///< the session is complete
};

/// "condition", "mount", "rest", "cycle", "loop", "hold", "break", "done".
std::string name(TaskKind kind);

/// One instruction to the operator, in numbers. Values that a kind does not need are 0.
struct Task {
  TaskKind kind = TaskKind::kRest;
  std::uint32_t step = 0;    ///< number of the step in the plan
  std::string surface;       ///< name of the surface on which the sheet should lie
  std::uint32_t mount = 0;   ///< number of the mount
  std::uint32_t cycle = 0;   ///< number of this cycle, from 1
  std::uint32_t cycles = 0;  ///< number of cycles on this mount
  double low = 0;            ///< of a loop, gauge [Pa]
  double peak = 0;           ///< of a cycle or loop, or the pressure to hold, gauge [Pa]
  double rate = 0;           ///< of filling and venting [Pa/s]; 0 = as before
  double dwell_peak = 0;     ///< at the peak [s]
  double dwell_rest = 0;     ///< without load before a cycle, or length of a rest or break [s]
  double duration = 0;       ///< planned length of the step [s]
  bool confirm = false;      ///< the operator must say when it is done
  /// What hinders, and why the last attempt was rejected: "no scan came for 2 s; rejected: the peak was 496
  /// kPa, not 620 kPa". Empty = first attempt.
  std::string remark;
};

/// Throws InputError where a pressure, rate or time is out of range, or a surface has no name.
void validate(const Task& task);
/// The part of a remark that says why an attempt was rejected; empty = it was not.
std::string rejection(const std::string& remark);

/// One thing that the operator does with the hands, apart from the chamber's valves.
struct Act {
  enum class Kind {
    kTakeOff,  ///< the sheet lies on no surface and gets no load
    kPutOn,    ///< puts the sheet on `surface`
    kConfirm,  ///< tells the conductor that it is done
    kOther,    ///< what a test lets an operator do
  };
  double time = 0;  ///< [s rig time]
  Kind kind = Kind::kConfirm;
  std::string surface;      ///< of kPutOn
  std::uint32_t mount = 0;  ///< of kPutOn: a new number each time that the sheet is put on
  std::string words;        ///< of kOther: what is done
  /// Of kOther: what it does to the board and its line at a time [s rig time].
  std::function<void(Board&, LineDamage&, double)> change;
  bool stays = false;  ///< is done also where a new instruction has come
};

/// "take the sheet off", "put the sheet on cylinder_7cm", "confirm" ...
std::string describe(const Act& act);

/// How the operator works. Each time is drawn evenly between two limits.
struct Habits {
  double reaction_least = 1, reaction_most = 3;  ///< from an instruction to the first move [s]
  double change_least = 20, change_most = 40;    ///< to put the sheet on a surface [s]
  double confirm = 2;                            ///< from the sheet put on to the confirmation [s]
  double peak = 0.01;                            ///< largest error of a peak, share
  double rate = 0.05;                            ///< likewise of a rate
  double dwell = 0.5;                            ///< longest delay at the end of a dwell [s]
  double patience = 120;                         ///< until a task that nobody accepts is done again [s]

  /// Reacts at once and hits every number exactly.
  static Habits exact();
};

struct OperatorOptions {
  std::uint64_t seed = 1;
  std::string lies_on = "flat";  ///< surface under the sheet at the start
  Habits habits;
};

/// A person at the rig who carries out instructions. Everything follows rig time; equal instructions at equal
/// times have equal consequences.
///
///     Operator person(options);
///     person.instruct(now, task);             // a new instruction
///     person.gaugePressure(now);              // of the chamber
///     for (Act& act : person.takeActs(now))   // what was done with the hands up to now
///
/// A new instruction ends what is being done, and so does the rejection of the present attempt, which is then
/// begun again. An instruction that is merely repeated is ignored. Who is not told anything after a cycle,
/// loop or hold does it again after a while. Tests derive an operator who makes mistakes.
class Operator {
 public:
  explicit Operator(const OperatorOptions& options);
  virtual ~Operator() = default;

  /// Instructions must come in time order. Throws InputError where one is out of range; then nothing changes.
  void instruct(double time, const Task& task);

  /// Gauge pressure of the chamber [Pa]. Up to the time of the last instruction it never changes.
  double gaugePressure(double time) const { return course_.at(time); }
  /// Acts up to `time` in their order; each is returned once.
  std::vector<Act> takeActs(double time);
  /// Time at which the present task will be done [s].
  double doneAt() const { return done_; }

 protected:
  /// Before a task is begun at `time`, and at a remark that asks for nothing else.
  virtual void prepare(double /*time*/, const Task& /*task*/) {}
  virtual void hear(double /*time*/, const Task& /*task*/) {}
  virtual void carryOut(Task task);
  virtual void mount(const Task& task);
  virtual void press(const Task& task);
  virtual void fill(const Task& task);
  virtual void hold(const Task& task);
  virtual void loop(const Task& task);
  virtual void rest(const Task& task);

  double draw(double least, double most);
  double around(double value, double share);
  void plan(Act act);
  void plan(double time, Act::Kind kind);
  void putOn(const std::string& surface);
  void confirmLater(double delay);
  void vent(double rate) { course_.rampTo(0, rate); }

  OperatorOptions options_;
  PressureCourse course_;
  std::vector<Act> acts_;      // by ascending time
  std::optional<Task> task_;   // as it was asked for
  double done_ = 0;            // its end [s]
  double deaf_until_ = 0;      // the operator does not look at instructions [s]
  Task pressed_;               // the last task that had a peak
  std::string asked_surface_;  // where the sheet should lie
  std::uint32_t asked_mount_ = 0;
  std::string lies_on_;             // where it will lie after the planned acts; empty = nowhere
  std::uint32_t put_on_mount_ = 0;  // task's mount at which the sheet was last put on

 private:
  void begin(double time, const Task& task);
  void forgetFrom(double time);

  statistics::RandomStream random_;
  std::uint64_t drawn_ = 0;
  std::string remark_;       // that was read last
  double begin_ = 0;         // of the task [s]
  std::uint32_t again_ = 0;  // how often the sheet was put on again during its mount
};

}  // namespace fsr::emulator
