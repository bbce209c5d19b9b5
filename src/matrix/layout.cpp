#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::matrix {

std::string sizeText(MatrixSize size) {
  return std::to_string(size.rows) + " x " + std::to_string(size.columns);
}

TaxelIndex Layout::index(std::uint16_t row, std::uint16_t column) const {
  return {std::size_t{row} * size.columns + column};
}

std::uint16_t Layout::row(TaxelIndex taxel) const {
  return static_cast<std::uint16_t>(taxel.value / size.columns);
}

std::uint16_t Layout::column(TaxelIndex taxel) const {
  return static_cast<std::uint16_t>(taxel.value % size.columns);
}

Position Layout::position(TaxelIndex taxel) const {
  return {pitch_x * (column(taxel) - 0.5 * (size.columns - 1)),
          pitch_y * (row(taxel) - 0.5 * (size.rows - 1))};
}

}  // namespace fsr::matrix
