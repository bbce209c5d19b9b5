#pragma once

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

}  // namespace fsr_rviz
