#pragma once

#include <cstddef>
#include <string>

namespace fsr::conductor {

/// What is to be done now. The numbers are those of msg/Instruction.msg.
enum class InstructionKind {
  kCondition = 0,
  kMount = 1,
  kRest = 2,
  kCycle = 3,
  kLoop = 4,
  kHold = 5,
  kBreak = 6,
  kDone = 7,
};

/// What a person is told, with the numbers in it. Pressures and times that a kind does not have are 0.
struct Instruction {
  std::string plan;
  std::size_t step = 0;  ///< from 1; of the last step where all is done
  std::size_t steps = 0;
  InstructionKind kind = InstructionKind::kDone;
  std::string text;  ///< a sentence
  std::string surface;
  unsigned mount = 0;     ///< from 1
  unsigned cycle = 0;     ///< number of this step among those of its kind on this mount, from 1
  unsigned cycles = 0;    ///< how many there are
  double low = 0;         ///< of a partial loop, gauge [Pa]
  double peak = 0;        ///< gauge [Pa]
  double rate = 0;        ///< of filling and venting [Pa/s]
  double dwell_peak = 0;  ///< [s]
  double dwell_rest = 0;  ///< [s]
  double duration = 0;    ///< planned time of the step [s]
  std::string remark;     ///< why the last attempt was rejected, and what hinders; empty = nothing
  bool confirm = false;   ///< a person must confirm
};

}  // namespace fsr::conductor
