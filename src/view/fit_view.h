#pragma once

#include <optional>
#include <vector>

#include "fsr_pressure_map/view/bent_sheet.h"

namespace fsr::view {

/// A camera that looks at a point from a distance, with the world's z axis upwards in the picture.
struct OrbitCamera {
  Vector3 focus;        ///< [m]
  double distance = 1;  ///< from the focus [m]
  double yaw = 0;       ///< of the way from the focus to the camera, about z from x [rad]
  double pitch = 0;     ///< of this way, above the plane of x and y [rad], less than a right angle
};

/// Half the picture's width and height at unit distance (ratio).
struct Lens {
  double wide = 1;
  double high = 1;
};

/// A part of the picture; the whole picture is -1 to 1 in both directions.
struct Window {
  double left = -1;
  double right = 1;
  double bottom = -1;
  double top = 1;
};

/// `camera` moved, but not turned, so that all points lie within the window and it is as near as possible.
/// The focus is at the depth of the points' middle. None without points or for an empty window.
///
/// A point lies left of the window's right edge where u - right wide w <= 0, with its place (u, w) to the
/// right of the camera and ahead of it. This is linear in the place of the camera, so that the nearest place
/// follows from the extreme points of the four edges without iteration.
std::optional<OrbitCamera> fitView(OrbitCamera camera, const std::vector<Vector3>& points, const Lens& lens,
                                   const Window& window);

}  // namespace fsr::view
