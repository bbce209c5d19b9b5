#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fsr::matrix {

/// Rows and columns of a sensor matrix.
struct MatrixSize {
  std::uint16_t rows = 0;
  std::uint16_t columns = 0;

  std::size_t taxels() const { return std::size_t{rows} * columns; }
};

inline bool operator==(MatrixSize a, MatrixSize b) {
  return a.rows == b.rows && a.columns == b.columns;
}
inline bool operator!=(MatrixSize a, MatrixSize b) {
  return !(a == b);
}

/// "7 x 10": rows x columns.
std::string sizeText(MatrixSize size);

/// Largest number of rows, and of columns, that the package accepts.
constexpr std::uint16_t kMaxMatrixSide = 64;

/// Number of a taxel, row-major: row * columns + column.
struct TaxelIndex {
  std::size_t value = 0;
};

/// A point of the flat sheet [m] in the matrix frame. The origin is the matrix's centre, x points along a row
/// (increasing column index), y along a column (increasing row index), z out of the loaded face.
struct Position {
  double x = 0;
  double y = 0;
};

/// Positions of the taxels of a matrix on its sheet.
struct Layout {
  MatrixSize size;
  double pitch_x = 0.010;  ///< distance between neighbours along a row [m]
  double pitch_y = 0.010;  ///< distance between neighbours along a column [m]

  TaxelIndex index(std::uint16_t row, std::uint16_t column) const;
  std::uint16_t row(TaxelIndex taxel) const;
  std::uint16_t column(TaxelIndex taxel) const;
  /// Centre of a taxel.
  Position position(TaxelIndex taxel) const;
};

}  // namespace fsr::matrix
