#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "view/taxel_look.h"

namespace fsr_rviz {

/// The values that are drawn on a sheet: pressure, its standard deviation, or counts.
struct SheetPicture {
  fsr::matrix::Layout layout;
  std::vector<float> values;  ///< [rows x columns], row-major, in the unit of the scale; NaN = no reading
  std::vector<fsr::view::TaxelLook> looks;  ///< [rows x columns], row-major
  fsr::view::PressureScale scale;
  bool smooth = true;    ///< colours are interpolated between taxels; false: one square for each taxel
  bool marks = true;     ///< marks on taxels with an unreliable reading
  bool stopped = false;  ///< the values are old: the sheet is drawn in grey, without marks
};

}  // namespace fsr_rviz
