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

InputError badTable(std::size_t number, const std::string& complaint) {
  return InputError("calibration: table " + std::to_string(number) + " " + complaint);
}

}  // namespace

PackedTables::PackedTables(const CurvatureTables& tables)
    : size_(tables.size), full_scale_(tables.full_scale), classes_(tables.classes.size()) {
  requireWhole(tables);
  entries_.reserve(tables.tables.size() * codes());
  for (const CodeTable& table : tables.tables) {
    const std::size_t now = trained_.size();
    if (table.pressure.size() != codes() || table.deviation.size() != codes()) {
      throw badTable(now, "has " + std::to_string(table.pressure.size()) +
                              " codes, but must have full scale + 1, " + std::to_string(codes()));
    }
    for (std::size_t code = 0; code < codes(); ++code) {
      const TableEntry entry{table.pressure[code], table.deviation[code]};
      if (!std::isfinite(entry.pressure) || !std::isfinite(entry.deviation)) {
        throw badTable(now, "is not finite at code " + std::to_string(code) + ", but must be in Pa");
      }
      entries_.push_back(entry);
    }
    trained_.push_back({table.lowest, table.highest});
  }
}

}  // namespace fsr
