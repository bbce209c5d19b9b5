#pragma once

#include <string>

#include "dataset/table_recording.h"

namespace fsr::dataset {

/// How the numbers of a column become SI: factor * (value + offset), or 1 over that.
struct TableUnit {
  double factor = 1;
  double offset = 0;
  std::string quantity = {};  ///< where a role may be several: counts, V, S; N of a reference
  bool inverse = false;       ///< resistance -> conductance
};

/// Throws InputError where the column's role has no such unit.
TableUnit unitOf(const TableColumn& column);

}  // namespace fsr::dataset
