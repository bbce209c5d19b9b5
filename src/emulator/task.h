#pragma once

#include <cstdint>
#include <string>

namespace fsr::emulator {

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

/// Whether two instructions ask for the same, whatever they remark.
bool sameTask(const Task& a, const Task& b);
/// The part of a remark that says why an attempt was rejected; empty = it was not.
std::string rejection(const std::string& remark);

/// Throws InputError where a pressure, rate or time is out of range, or a surface has no name.
void validate(const Task& task);

}  // namespace fsr::emulator
