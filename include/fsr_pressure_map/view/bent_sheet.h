#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::view {

/// A point or direction in the matrix frame.
struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// Where a taxel lies once the sheet is bent.
struct TaxelPose {
  Vector3 position;  ///< centre of the taxel [m]
  Vector3 normal;    ///< out of the loaded face, length 1
};

/// Bends the flat sheet over a surface: the pose of each taxel [rows x columns], row-major. The middle
/// of the sheet stays at the origin with its normal along +z; positive curvature falls away from +z on
/// all sides. An unknown surface is drawn flat. Throws InputError where the surface's values do not fit
/// the matrix.
///
/// Construction: a frame (along the row, along the column, normal) walks up and down the middle column
/// from the middle of the sheet, then along each row from there. Moving by ds in the direction u of the
/// sheet turns the normal by K u ds, K = [[x, xy], [xy, y]], without turning within the sheet; between
/// neighbours K is the mean of the two, so each step is a screw motion in closed form.
///
/// So lengths along every row and along the middle column are those of the flat sheet; any uniform
/// cylinder, whatever its axis, and any uniform sphere come out exactly. A sheet cannot follow two
/// curvatures at once without stretching: there, neighbouring rows open or close at their ends.
std::vector<TaxelPose> bendSheet(const matrix::Layout& layout, const matrix::Surface& surface);

}  // namespace fsr::view
