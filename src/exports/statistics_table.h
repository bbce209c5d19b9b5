#pragma once

#include <memory>
#include <string>

#include "exports/region_readings.h"
#include "exports/row_table.h"

namespace fsr::exports {

/// A table with one row for each region and scan. HDF5 holds units and meanings of the columns.
class StatisticsTable : public ScanSink {
 public:
  StatisticsTable(const std::string& path, const StatisticsOptions& options);

  void begin(const ExportSubject& subject) override;
  void add(const ScanRecord& scan) override;
  void finish() override { table_->finish(); }

 private:
  StatisticsOptions options_;
  double factor_;  // of pressures in the table [unit / Pa]
  RegionReader reader_;
  std::unique_ptr<RowTable> table_;
  std::string bag_, sheet_;
};

}  // namespace fsr::exports
