#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/pressure_scale.h"
#include "view/taxel_look.h"

namespace fsr_rviz {

/// What is drawn on a sheet, whatever it is: a pressure, its deviation, or counts.
struct SheetPicture {
  fsr::matrix::Layout layout;
  std::vector<float> values;  ///< [rows x columns], row-major, in what the scale measures; NaN = no reading
  std::vector<fsr::view::TaxelLook> looks;  ///< likewise
  fsr::view::PressureScale scale;
  bool smooth = true;  ///< colours run over from taxel to taxel; false: a square each
  bool marks = true;   ///< on taxels that are not to be believed
};

}  // namespace fsr_rviz
