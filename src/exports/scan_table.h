#pragma once

#include <hdf5.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exports/scan_record.h"
#include "hdf5/column.h"

// Only sources include this header: it needs HDF5's own.

namespace fsr::exports {

/// Scans as datasets of the group /scans, with one entry for each scan, in the order of their stamps:
///
///   stamp [ns], time [s]           since 1970, UTC; since the first scan
///   raw, pressure_map              rows of scan and map in the datasets of their topics; -1 = none
///   chamber_pressure [Pa]          gauge, interpolated to the scan; NaN = unknown
///   temperature [degree Celsius]   interpolated to the scan; NaN = unknown
///   cycle, mount                   0 = unknown
///   surface, session, event        rows of surface_names, session_names, event_names; "" = unknown
class ScanTable : public ScanSink {
 public:
  /// `path` is the file's path for messages.
  ScanTable(hid_t file, const std::string& path);

  void begin(const ExportSubject& /*subject*/) override {}
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  // Texts that repeat: each is stored once, and the scans have its row.
  struct Labels {
    std::map<std::string, std::uint32_t> row;
    std::vector<std::string> names;
    std::unique_ptr<hdf5::ColumnWriter> column;
  };
  template <typename T>
  void put(const char* name, T value);
  void label(const std::string& name, const std::string& text);
  void lay(const char* name, hid_t type, const char* unit, const char* meaning);

  hid_t file_;
  std::string path_;
  std::map<std::string, std::unique_ptr<hdf5::ColumnWriter>> columns_;
  std::map<std::string, Labels> labels_;
};

}  // namespace fsr::exports
