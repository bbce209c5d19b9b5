#pragma once

#include <string>

#include "dataset/table_recording.h"

namespace fsr::dataset {

/// Conversion of a column to SI: factor * (value + offset), or the inverse of that.
struct TableUnit {
  double factor = 1;
  double offset = 0;
  std::string quantity = {};  ///< for roles with several quantities: counts, V, S; N of a reference
  bool inverse = false;       ///< resistance -> conductance
};

/// Throws InputError where the column's role has no such unit.
TableUnit unitOf(const TableColumn& column);

}  // namespace fsr::dataset
