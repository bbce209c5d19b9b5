#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/map_layer.h"
#include "view/bent_sheet.h"
#include "view/taxel_look.h"

namespace fsr::view {

/// The whole bent sheet, to its edges half a pitch beyond the outer taxels' centres, as triangles:
/// `fineness` x `fineness` small squares for each taxel, two triangles each. Bent as bendSheet() does; where
/// curvature differs from taxel to taxel it runs over between their centres.
class SheetMesh {
 public:
  /// `fineness` 1 to 16. Throws InputError where the surface does not fit the matrix.
  SheetMesh(const matrix::Layout& layout, const matrix::Surface& surface, int fineness);

  const matrix::Layout& layout() const { return layout_; }
  /// Corners of the triangles, three each, counter-clockwise seen from the loaded face; taxel after taxel,
  /// `cornersOfTaxel()` of them each.
  const std::vector<Vector3>& corners() const { return corners_; }
  std::size_t cornersOfTaxel() const { return std::size_t(6) * fineness_ * fineness_; }

  /// Colours of corners(): one for each taxel, or running over from taxel to taxel; no reading is grey.
  /// `values` [rows x columns], row-major, in what the scale measures, NaN = no reading.
  void colourCells(const std::vector<float>& values, const PressureScale& scale,
                   std::vector<Colour>& colours) const;
  void colourSmoothly(const std::vector<float>& values, const PressureScale& scale,
                      std::vector<Colour>& colours) const;

  /// The point of the sheet at taxel coordinates (0, 0 = centre of taxel 0, 0), `lift` [m] above its face.
  Vector3 point(double row, double column, double lift = 0) const;

  /// Area of each taxel on the bent sheet [rows x columns], row-major [m^2].
  std::vector<double> areas() const;

 private:
  std::size_t vertex(int row, int column) const {
    return std::size_t(row) * (std::size_t(layout_.size.columns) * fineness_ + 1) + std::size_t(column);
  }
  template <typename Visit>
  void forEachCorner(Visit visit) const;

  matrix::Layout layout_;
  int fineness_;
  std::vector<TaxelPose> vertices_;  // [rows * fineness + 1, columns * fineness + 1]
  std::vector<Vector3> corners_;
};

/// Area of each taxel on the bent sheet [rows x columns], row-major [m^2]: that of the flat sheet wherever
/// the surface bends one way only (a cylinder, a cone). Its error is below 1e-4 for a radius of 5 cm and a
/// pitch of 1 cm.
std::vector<double> taxelAreas(const matrix::Layout& layout, const matrix::Surface& surface);

}  // namespace fsr::view
