#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/bent_sheet.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "view/taxel_look.h"

namespace fsr::view {

/// The bent sheet as triangles. Its edges are half a pitch beyond the centres of the outer taxels. Each taxel
/// has `fineness` x `fineness` small squares of two triangles. The sheet is bent by bendSheet(); curvature
/// that differs between taxels is interpolated between their centres.
class SheetMesh {
 public:
  /// `fineness` is 1 to 16. Throws InputError if the surface does not fit the matrix.
  SheetMesh(const matrix::Layout& layout, const matrix::Surface& surface, int fineness);

  const matrix::Layout& layout() const { return layout_; }
  /// Corners of the triangles, three for each triangle, counter-clockwise seen from the loaded face. They are
  /// ordered by taxel, cornersOfTaxel() for each.
  const std::vector<Vector3>& corners() const { return corners_; }
  std::size_t cornersOfTaxel() const { return std::size_t(6) * fineness_ * fineness_; }

  /// Colours of corners(): one colour for each taxel (colourCells), or interpolated between taxels
  /// (colourSmoothly). Taxels without a reading are grey. `values` [rows x columns], row-major, in the unit
  /// of the scale, NaN = no reading.
  void colourCells(const std::vector<float>& values, const PressureScale& scale,
                   std::vector<Colour>& colours) const;
  void colourSmoothly(const std::vector<float>& values, const PressureScale& scale,
                      std::vector<Colour>& colours) const;

  /// The point at taxel coordinates (0, 0 = centre of taxel 0, 0), `lift` [m] above the loaded face.
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

}  // namespace fsr::view
