#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

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

}  // namespace fsr::view
