#pragma once

#include <hdf5.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exports/scan_record.h"
#include "hdf5/column.h"
#include "settings/replace_file.h"

// Only sources include this header: it needs HDF5's own.

namespace fsr::exports {

/// The scans of a recording as datasets of the group /scans of an HDF5 file, with one entry for each scan, in
/// the order of their stamps. docs/exports.md describes them; the attributes `unit` and `meaning` of a
/// dataset do so in the file.
class ScanTable : public ScanSink {
 public:
  explicit ScanTable(const std::string& path) : path_(path), fresh_(path) {}

  void begin(const ExportSubject& subject) override { subject_ = subject; }
  /// Throws InputError if the size of the matrix has changed.
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  // Texts that repeat: each is stored once, and the scans have its row.
  struct Labels {
    std::map<std::string, std::uint32_t> row;
    std::vector<std::string> names;
  };
  template <typename T>
  void put(const char* name, T value);
  template <typename T>
  void putAll(const char* name, const std::vector<T>& values);
  void putTaxels(const ScanRecord& scan);
  void label(const char* name, const std::string& text);
  void lay(const char* name, hid_t type, const char* unit, const char* meaning, bool each_taxel = false);
  void open(const ScanRecord& first);

  std::string path_;
  settings::FreshPath fresh_;
  ExportSubject subject_;
  matrix::MatrixSize size_;
  std::optional<hdf5::Handle> file_;
  std::map<std::string, std::unique_ptr<hdf5::ColumnWriter>> columns_;
  std::map<std::string, Labels> labels_;
};

}  // namespace fsr::exports
