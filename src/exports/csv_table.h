#pragma once

#include <string>

#include "exports/scan_record.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// A tidy long table: one row for each taxel and scan, of one recording after the other. The columns, with
/// their units, stand in kCsvHeader; docs/exports.md describes each. What is not known is NA; numbers read
/// back as exactly those that were recorded; texts with a comma or quote are quoted. R reads it with
/// read.csv(), Octave and MATLAB with textscan(). A path that ends with .gz is written compressed.
class CsvTable : public ScanSink {
 public:
  explicit CsvTable(const std::string& path);

  void begin(const ExportSubject& subject) override;
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  settings::FreshFile file_;
  std::string bag_;
  std::string row_;  // kept for its memory
};

/// The last column is never NA: Octave's textscan() would read a NA at the very end of a file as 0.
constexpr char kCsvHeader[] =
    "bag,session,surface,mount,cycle,event,time_s,sequence,row,column,counts,pressure_Pa,deviation_Pa,flags,"
    "state,chamber_pressure_gauge_Pa,temperature_degC,curvature_per_m,stamp_s";

}  // namespace fsr::exports
