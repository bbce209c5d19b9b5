#include "fsr_pressure_map/calibration/packed_tables.h"

#include <cmath>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {

namespace {

void requireWhole(const CurvatureTables& tables) {
  const std::size_t expected = tables.size.taxels() * tables.classes.size();
  if (expected == 0 || tables.tables.size() != expected) {
    throw InputError("calibration has " + std::to_string(tables.tables.size()) +
                     " tables, but must have one for each taxel and curvature class, " +
                     std::to_string(expected));
  }
}

// One value for each code, all of them finite or, for want of a model, all of them NaN.
void requireSound(const CodeTable& table, std::size_t codes, std::size_t number) {
  const std::string which = "calibration: table " + std::to_string(number);
  if (table.pressure.size() != codes || table.deviation.size() != codes) {
    throw InputError(which + " has " + std::to_string(table.pressure.size()) +
                     " codes, but must have full scale + 1, " + std::to_string(codes));
  }
  const bool model = !std::isnan(table.pressure.front());
  for (std::size_t code = 0; code < codes; ++code) {
    const bool finite = std::isfinite(table.pressure[code]) && std::isfinite(table.deviation[code]);
    const bool absent = std::isnan(table.pressure[code]) && std::isnan(table.deviation[code]);
    if (model ? !finite : !absent) {
      throw InputError(which + " is not finite at code " + std::to_string(code) + ", but must be in Pa");
    }
  }
}

}  // namespace

PackedTables::PackedTables(const CurvatureTables& tables)
    : size_(tables.size), full_scale_(tables.full_scale), classes_(tables.classes.size()) {
  requireWhole(tables);
  entries_.resize(size_.taxels() * stride());
  for (std::size_t taxel = 0; taxel < size_.taxels(); ++taxel) {
    for (std::size_t k = 0; k < classes_; ++k) {
      const CodeTable& table = tables.table(taxel, k);
      requireSound(table, codes(), number(taxel, k));
      TableEntry* entry = entries_.data() + taxel * stride() + k * codes();
      for (std::size_t code = 0; code < codes(); ++code) {
        *entry++ = {table.pressure[code], table.deviation[code]};
      }
      trained_.push_back({table.lowest, table.highest, !std::isnan(table.pressure.front())});
    }
  }
}

}  // namespace fsr
