#pragma once

#include <fsr_pressure_map/Instruction.h>

#include <QWidget>
#include <cmath>

#include "fsr_pressure_map/view/colour_map.h"

namespace fsr_rviz {

/// Pressure of the chamber in large digits beside its target, above a bar of both: to be read from the
/// valves, some metres away. A number that is NaN is shown as "-". The accessible name says the same in
/// words.
class PressureGauge : public QWidget {
 public:
  explicit PressureGauge(QWidget* parent = nullptr);

  /// `full`: pressure at the end of the bar. All gauge [Pa].
  void show(double now, double target, double full, fsr::view::PressureUnit unit);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double now_ = NAN, target_ = NAN, full_ = 1;
  fsr::view::PressureUnit unit_ = fsr::view::PressureUnit::kKilopascal;
};

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
