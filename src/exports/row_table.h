#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace fsr::exports {

/// A column of a table of rows.
struct TableColumn {
  std::string name;
  std::string unit;  ///< empty = none
  std::string meaning;
  bool text = false;  ///< whether its values are texts
  int digits = 7;     ///< significant digits of a number in CSV
};

using TableValue = std::variant<double, std::string>;

/// A table that is written row by row and appears complete or not at all. Each function throws InputError if
/// the output cannot be written.
class RowTable {
 public:
  virtual ~RowTable() = default;
  /// One value for each column, a text where the column has texts. NaN and "" = unknown.
  virtual void add(const std::vector<TableValue>& row) = 0;
  virtual void finish() = 0;
};

/// CSV with the header name_unit, in which an unknown value is NA; or, where the path ends with .h5, HDF5
/// with a dataset for each column in the group `name`, with the attributes `unit` and `meaning`.
std::unique_ptr<RowTable> openRowTable(const std::string& path, const std::string& name,
                                       std::vector<TableColumn> columns);

/// An unknown value in CSV.
constexpr char kAbsent[] = "NA";

/// A text for CSV: quoted where it needs to be; kAbsent where it is empty.
std::string quotedCell(const std::string& text);

}  // namespace fsr::exports
