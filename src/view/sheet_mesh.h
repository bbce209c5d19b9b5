#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/bent_sheet.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "view/taxel_look.h"

namespace fsr::view {

/// Interpolates a layer bilinearly between taxel centres. Beyond the outer centres it is constant. A point
/// nearest to a taxel without a value is NaN; elsewhere such a taxel is left out of the interpolation. Keeps
/// a pointer to `values` [rows x columns], row-major: they must outlive this object.
class SmoothLayer {
 public:
  SmoothLayer(const std::vector<float>& values, matrix::MatrixSize size)
      : values_(values.data()), size_(size) {}

  /// A coordinate along rows or columns: the two taxels beside it, and its distance from the first [pitch].
  struct Place {
    int low = 0;
    int high = 0;
    double part = 0;
  };
  /// Coordinate 0 is the centre of row (column) 0, coordinate 1 that of the next one.
  Place row(double coordinate) const { return place(coordinate, size_.rows); }
  Place column(double coordinate) const { return place(coordinate, size_.columns); }

  double at(const Place& row, const Place& column) const;
  /// at() for all `columns` of one row; faster than single calls if every taxel has a value.
  void alongRow(const Place& row, const std::vector<Place>& columns, std::vector<double>& result) const;
  double at(double r, double c) const { return at(row(r), column(c)); }

 private:
  static Place place(double coordinate, int count);
  double patched(const Place& row, const Place& column) const;
  double value(int row, int column) const { return double(values_[row * size_.columns + column]); }

  const float* values_;
  matrix::MatrixSize size_;
};

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
