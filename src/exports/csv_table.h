#pragma once

#include <string>

#include "exports/scan_record.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// A tidy long table with one row for each taxel and scan; several recordings follow each other. kCsvHeader
/// has the columns with their units; docs/exports.md describes each. Unknown values are NA. Numbers read back
/// as exactly the recorded ones. Texts with a comma or quotation mark are quoted. R reads the table with
/// read.csv(), Octave and MATLAB with textscan(). If the path ends with .gz, the file is compressed.
class CsvTable : public ScanSink {
 public:
  explicit CsvTable(const std::string& path);

  void begin(const ExportSubject& subject) override;
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  settings::FreshFile file_;
  std::string bag_;
  std::string row_;  // a member so that its memory is used again
};

/// The last column is no number, since Octave's textscan() would read NA at the end of a file as 0. `flags`
/// is what `taxel_flags` is. It stays until 0.3 (docs/stability.md); pandas has an attribute of that name.
constexpr char kCsvHeader[] =
    "bag,session,surface,mount,cycle,event,time_s,sequence,row,column,counts,pressure_Pa,deviation_Pa,flags,"
    "state,chamber_pressure_gauge_Pa,temperature_degC,curvature_per_m,stamp_s,taxel_flags";

}  // namespace fsr::exports
