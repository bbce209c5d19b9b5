#include "exports/row_table.h"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "exports/hdf5_output.h"
#include "hdf5/column.h"
#include "settings/number_text.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr::exports {

namespace {

constexpr std::size_t kLongestText = 256;  // in HDF5 [bytes]

class CsvRows : public RowTable {
 public:
  CsvRows(const std::string& path, std::vector<TableColumn> columns)
      : file_(path, settings::file_kind::kTable), columns_(std::move(columns)) {
    std::string line;
    for (const TableColumn& column : columns_) {
      std::string unit = column.unit;
      std::replace(unit.begin(), unit.end(), ' ', '_');
      line += (line.empty() ? "" : ",") + column.name + (unit.empty() ? "" : "_" + unit);
    }
    file_.write(line + '\n');
  }

  void add(const std::vector<TableValue>& row) override {
    std::string line;
    for (std::size_t i = 0; i < columns_.size(); ++i) line += (i == 0 ? "" : ",") + cell(columns_[i], row[i]);
    file_.write(line + '\n');
  }

  void finish() override { file_.finish(); }

 private:
  static std::string cell(const TableColumn& column, const TableValue& value) {
    if (column.text) return quotedCell(std::get<std::string>(value));
    const double number = std::get<double>(value);
    return std::isnan(number) ? kAbsent : settings::roundedText(number, column.digits);
  }

  settings::FreshFile file_;
  std::vector<TableColumn> columns_;
};

class Hdf5Rows : public RowTable {
 public:
  Hdf5Rows(const std::string& path, const std::string& name, const std::vector<TableColumn>& columns)
      : path_(path), fresh_(path) {
    attempt(path_, [&] {
      createFile(fresh_.name(), name, file_);
      for (const TableColumn& column : columns) {
        hdf5::ColumnPlan plan;
        plan.path = name + '/' + column.name;
        plan.type = column.text ? 0 : H5T_NATIVE_DOUBLE;
        plan.text_size = kLongestText;
        plan.unit = column.unit;
        plan.meaning = column.meaning;
        columns_.push_back(std::make_unique<hdf5::ColumnWriter>(*file_, plan));
      }
    });
  }

  void add(const std::vector<TableValue>& row) override {
    attempt(path_, [&] {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        if (const auto* text = std::get_if<std::string>(&row[i])) {
          columns_[i]->appendText(std::string_view(*text).substr(0, kLongestText));
        } else {
          columns_[i]->append(&std::get<double>(row[i]), 1);
        }
      }
    });
  }

  void finish() override {
    attempt(path_, [&] {
      for (const auto& column : columns_) column->finish();
      columns_.clear();
      closeFile(file_);
    });
    fresh_.finish();
  }

 private:
  std::string path_;
  settings::FreshPath fresh_;
  std::optional<hdf5::Handle> file_;
  std::vector<std::unique_ptr<hdf5::ColumnWriter>> columns_;
};

}  // namespace

std::unique_ptr<RowTable> openRowTable(const std::string& path, const std::string& name,
                                       std::vector<TableColumn> columns) {
  if (std::filesystem::path(path).extension() == ".h5")
    return std::make_unique<Hdf5Rows>(path, "/" + name, columns);
  return std::make_unique<CsvRows>(path, std::move(columns));
}

std::string quotedCell(const std::string& text) {
  if (text.empty()) return kAbsent;
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"') safe += '"';
    safe += c == '\n' || c == '\r' ? ' ' : c;  // simple readers take each line for a row
  }
  return safe + '"';
}

}  // namespace fsr::exports
