#pragma once

#include <fsr_pressure_map/Instruction.h>

namespace fsr_rviz {

/// Where a person at the valves should go next: up to the peak of the present step, and down again once it
/// has been there.
class PressureTarget {
 public:
  /// Target for the present pressure `now`, both gauge [Pa]; NaN where the instruction asks for none. Call it
  /// for each reading.
  double next(const fsr_pressure_map::Instruction& instruction, double now);

 private:
  std::uint32_t step_ = 0;
  bool reached_ = false;  // the peak of the present attempt
  bool down_ = false;
};

}  // namespace fsr_rviz
