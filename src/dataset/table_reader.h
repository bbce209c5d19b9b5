#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::dataset {

/// Format of a table.
struct TableFormat {
  /// Between the cells: ',', ';', a tab, or ' ' for white space of any length; 0 = detected from the first
  /// row.
  char separator = 0;
  enum class Header {
    kTold,
    kYes,
    kNo
  } header = Header::kTold;    ///< kTold: a first row that is not a number is a header
  bool decimal_comma = false;  ///< 3,14 instead of 3.14
  std::size_t skip_lines = 0;  ///< before the table begins
};

/// Reads a text table row by row, plain or gzipped. Empty lines and lines that begin with # are skipped.
/// Quotes around a cell and a carriage return at the end of a line are removed. Every error names file, line
/// and column.
class TableReader {
 public:
  /// Throws InputError where the file cannot be read or has no row.
  explicit TableReader(const std::string& path, const TableFormat& format = {});
  ~TableReader();

  /// Names of the columns; empty where the table has no header.
  const std::vector<std::string>& names() const { return names_; }
  std::size_t columns() const { return columns_; }
  /// The column with this name, or this number counted from 1. Throws InputError.
  std::size_t find(const std::string& column) const;
  /// The same for one column, or for FIRST-LAST: all from one column to another, in the order of the table.
  std::vector<std::size_t> findAll(const std::string& columns) const;

  /// Reads the next row; false at the end. Throws InputError where a row has more or fewer cells than the
  /// first.
  bool next();
  const std::string& text(std::size_t column) const { return cells_[column]; }
  /// Throws InputError where the cell is not a finite number.
  double number(std::size_t column) const;
  /// The same, but infinity is accepted.
  double numberOrInfinity(std::size_t column) const;
  std::size_t line() const;

  /// An InputError about a cell of this row: "FILE, line 7, column force_N: " + `complaint`.
  [[nodiscard]] settings::InputError error(std::size_t column, const std::string& complaint) const;

 private:
  struct Source;
  void begin();
  std::optional<std::size_t> known(const std::string& column) const;
  std::string nameOf(std::size_t column) const;
  bool readCells();

  std::unique_ptr<Source> source_;
  std::string path_;
  TableFormat format_;
  std::vector<std::string> names_;
  std::vector<std::string> cells_;
  std::size_t columns_ = 0;
  bool first_is_pending_ = false;  // the first row of numbers was read to detect the format
};

}  // namespace fsr::dataset
