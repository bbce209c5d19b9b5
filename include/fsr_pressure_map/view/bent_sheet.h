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

/// Pose of a taxel on the bent sheet.
struct TaxelPose {
  Vector3 position;  ///< centre of the taxel [m]
  Vector3 normal;    ///< out of the loaded face, length 1
};

/// Bends the flat sheet over a surface and returns the pose of each taxel [rows x columns], row-major. The
/// middle of the sheet stays at the origin with its normal along +z. A sheet of positive curvature falls away
/// from +z. An unknown surface is drawn flat. Throws InputError if the surface's values do not fit the
/// matrix.
///
/// Construction: a frame (along the row, along the column, normal) moves up and down the middle column from
/// the middle of the sheet, then along each row. A step ds in the direction u of the sheet turns the normal
/// by K u ds, K = [[x, xy], [xy, y]], without rotation within the sheet. Between neighbouring taxels, K is
/// the mean of the two, so each step is a screw motion in closed form.
///
/// Lengths along every row and along the middle column are therefore those of the flat sheet. Uniform
/// cylinders of any axis and uniform spheres are exact. A sheet cannot follow two curvatures at once without
/// stretching: on such a surface the ends of neighbouring rows move apart or together.
std::vector<TaxelPose> bendSheet(const matrix::Layout& layout, const matrix::Surface& surface);

/// Area of each taxel on the bent sheet [rows x columns], row-major [m^2]. It equals that of the flat sheet
/// on surfaces that bend in one direction only (cylinder, cone). The relative error is below 1e-4 for a
/// radius of 5 cm and a pitch of 1 cm.
std::vector<double> taxelAreas(const matrix::Layout& layout, const matrix::Surface& surface);

}  // namespace fsr::view
