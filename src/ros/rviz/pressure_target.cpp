#include "ros/rviz/pressure_target.h"

#include <cmath>

namespace fsr_rviz {

namespace {

using fsr_pressure_map::Instruction;

constexpr double kNear = 0.05;  // of the way from `low` to `peak`, as a plan's usual tolerance of the peak

}  // namespace

double PressureTarget::next(const Instruction& instruction, double now) {
  if (step_ != instruction.step) *this = PressureTarget();
  step_ = instruction.step;
  const bool loads = instruction.kind == Instruction::CYCLE || instruction.kind == Instruction::CONDITION ||
                     instruction.kind == Instruction::LOOP || instruction.kind == Instruction::HOLD;
  const bool vents = instruction.kind == Instruction::REST || instruction.kind == Instruction::MOUNT ||
                     instruction.kind == Instruction::BREAK;
  if (instruction.confirm || vents) return 0;
  if (!loads || instruction.steps == 0) return NAN;
  if (instruction.kind == Instruction::HOLD) return instruction.peak;
  const double near = kNear * (instruction.peak - instruction.low);
  if (now >= instruction.peak - near) reached_ = true;
  if (reached_ && now < instruction.peak - near) down_ = true;
  if (down_ && now <= instruction.low + near) down_ = reached_ = false;  // the next attempt
  return down_ ? instruction.low : instruction.peak;
}

}  // namespace fsr_rviz
