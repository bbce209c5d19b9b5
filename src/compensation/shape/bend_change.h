#pragma once

#include "compensation/shape/read_shape.h"
#include "fsr_pressure_map/compensation/shape.h"

namespace fsr::compensation {

/// Tells whether the bend changes along the sheet: the most likely centre and changes along both axes,
/// against the constant bend of `constant` (likelihood ratio with two degrees of freedom). Deviations follow
/// from the curvature of the likelihood there. `model` must be that of the reader. Throws as
/// ShapeReader::estimate().
ChangingBend tellBendChange(const ShapeReader& reader, const ShapeModel& model, const RestReading& rest,
                            const ShapeEstimate& constant);

}  // namespace fsr::compensation
