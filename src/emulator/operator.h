#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/mistakes.h"
#include "emulator/pressure_course.h"
#include "emulator/task.h"
#include "statistics/random_stream.h"

namespace fsr::emulator {

/// One thing that the operator does with the hands, apart from the chamber's valves.
struct Act {
  enum class Kind {
    kTakeOff,  ///< the sheet lies on no surface and gets no load
    kPutOn,    ///< puts the sheet on `surface`
    kConfirm,  ///< tells the conductor that it is done
    kUnplugBoard,
    kPlugBoard,
    kUnplugTransducer,  ///< it reads the lower end of its range
    kSilenceTransducer,
    kPlugTransducer,
    kLoseTaxel,  ///< a taxel has no contact; its reading is 0
    kFixTaxels,
    kCloseTerminal,
  };
  double time = 0;  ///< [s rig time]
  Kind kind = Kind::kConfirm;
  std::string surface;       ///< of kPutOn
  std::uint32_t mount = 0;   ///< of kPutOn: a new number each time that the sheet is put on
  bool turned_over = false;  ///< of kPutOn: the other face is up
  double pick = 0;           ///< of kLoseTaxel: which taxel, as a share of the matrix, 0 .. 1
};

/// "take off", "put on cylinder_7cm (mount 2)", "confirm" ...
std::string describe(const Act& act);

/// How the operator works. Each time is drawn evenly between two limits.
struct Habits {
  double reaction_least = 1, reaction_most = 3;  ///< from an instruction to the first move [s]
  double change_least = 20, change_most = 40;    ///< to put the sheet on a surface [s]
  double confirm = 2;                            ///< from the sheet put on to the confirmation [s]
  double peak = 0.01;                            ///< largest error of a peak, share
  double rate = 0.05;                            ///< likewise of a rate
  double dwell = 0.5;                            ///< longest delay at the end of a dwell [s]
  double patience = 120;  ///< until a forgotten task, or one that nobody accepts, is noticed unasked [s]
  double repair = 30;     ///< until something unplugged is noticed unasked [s]

  /// Reacts at once and hits every number exactly.
  static Habits exact();
};

struct OperatorOptions {
  std::vector<ScriptedMistake> mistakes;
  std::uint64_t seed = 1;
  /// Names of the surfaces on the shelf beside the rig, in their order. Mistakes about surfaces need two.
  std::vector<std::string> shelf;
  std::string lies_on = "flat";  ///< surface under the sheet at the start
  Habits habits;
};

/// A mistake that was made.
struct MadeMistake {
  std::string name;
  std::uint32_t step = 0;  ///< of the task in which it was made
  double time = 0;         ///< at which that task was begun [s rig time]
};

/// A person at the rig who carries out instructions, with scripted mistakes. Everything follows rig time;
/// equal instructions at equal times have equal consequences.
///
///     Operator person(options);
///     person.instruct(now, task);             // a new instruction
///     person.gaugePressure(now);              // of the chamber
///     for (Act& act : person.takeActs(now))   // what was done with the hands up to now
///
/// A new instruction ends what is being done, and so does the rejection of the present attempt, which is then
/// begun again. An instruction that is merely repeated is ignored, unless its remark has become another one:
/// then the operator plugs in what is unplugged, presses the connector of the sheet down, and confirms what
/// was forgotten. At the next attempt a sheet that has slipped off is put on again, and also one on a wrong
/// surface if the rejection has the word "surface" or "sheet". Who is not told anything after a cycle, loop
/// or hold does it again after a while.
class Operator {
 public:
  /// Throws InputError.
  explicit Operator(const OperatorOptions& options);

  /// Instructions must come in time order. Throws InputError where one is out of range; then nothing changes.
  void instruct(double time, const Task& task);

  /// Gauge pressure of the chamber [Pa]. Up to the time of the last instruction it never changes.
  double gaugePressure(double time) const { return course_.at(time); }
  /// Acts up to `time` in their order; each is returned once.
  std::vector<Act> takeActs(double time);
  /// Time at which the present task will be done [s].
  double doneAt() const { return done_; }

  const std::vector<MadeMistake>& made() const { return made_; }
  /// Names of the scripted mistakes that no task has suited so far.
  std::vector<std::string> pending() const;

 private:
  enum class Keep { kWithTask, kAlways, kRepair };  // what a new instruction does to a planned act
  struct PlannedAct {
    Act act;
    Keep keep;
  };
  double draw(double least, double most);
  double around(double value, double share);
  Mistake nextMistake(const Task& task, double time);
  void forgetFrom(double time);
  void plan(double time, Act::Kind kind, Keep keep = Keep::kWithTask);
  void insert(const PlannedAct& planned);
  void putOn(const std::string& surface, bool turned_over, Keep keep = Keep::kWithTask);
  void begin(double time, const Task& task);
  void repair(double time);
  void putSheetRight();
  void carryOut(const Task& task, Slip slip);
  void mount(const Task& task, Slip slip);
  void confirmLater(double delay);
  void press(const Task& task, Slip slip);
  void fill(const Task& task, Slip slip);
  void handle(Slip slip, double half_way);
  void hold(const Task& task, Slip slip);
  void loop(const Task& task);
  void rest(const Task& task, Slip slip);
  std::string nextOnShelf(const std::string& surface) const;

  OperatorOptions options_;
  statistics::RandomStream random_;
  std::uint64_t drawn_ = 0;
  std::vector<bool> used_;  // of options_.mistakes
  std::vector<MadeMistake> made_;
  PressureCourse course_;
  std::vector<PlannedAct> acts_;  // by ascending time
  std::optional<Task> task_;      // as it was asked for
  std::string remark_;            // that was read last
  double begin_ = 0;              // of the task [s]
  double done_ = 0;               // its end [s]
  double deaf_until_ = 0;         // the operator does not look at instructions [s]
  Task pressed_;                  // the last task that had a peak
  std::string asked_surface_;     // where the sheet should lie
  std::uint32_t asked_mount_ = 0;
  std::string lies_on_;  // where it will lie after the planned acts; empty = nowhere
  bool turned_over_ = false;
  bool taxel_out_ = false;
  std::uint32_t put_on_mount_ = 0;      // task's mount at which the sheet was last put on
  std::uint32_t again_ = 0;             // how often it was put on again during that mount
  std::optional<std::string> swapped_;  // surface to be used at the next mount
};

}  // namespace fsr::emulator
