#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exports/row_table.h"
#include "exports/scan_formats.h"
#include "fsr_pressure_map/map/map_statistics.h"

namespace fsr::exports {

/// Statistics of a region in one scan. The deviations of mean and force are those of taxels that deviate
/// together, as they do by mount and temperature: an upper limit, where taxels deviate independently.
struct RegionReading {
  map::RegionStatistics of;
  double mean_of_all = ScanRecord::kUnknown;      ///< over the taxels with a reading, weighted by area [Pa]
  double peak_deviation = ScanRecord::kUnknown;   ///< of the peak's taxel [Pa]
  double mean_deviation = ScanRecord::kUnknown;   ///< of the mean over the contact area [Pa]
  double force_deviation = ScanRecord::kUnknown;  ///< [N]
};

/// Computes the statistics of scans, as the view node does.
class RegionReader {
 public:
  explicit RegionReader(const StatisticsOptions& options) : options_(options) {}

  /// Called before the first scan of each recording. Throws InputError where it has no maps.
  void begin(const ExportSubject& subject);
  /// Of each region, the whole matrix first; empty where the scan has no map. Throws InputError where the
  /// region file cannot be used.
  const std::vector<RegionReading>& read(const ScanRecord& scan);

 private:
  StatisticsOptions options_;
  std::optional<map::MapStatistics> statistics_;
  std::shared_ptr<const matrix::Surface> surface_;
  std::vector<double> areas_;  // of the taxels [m^2]
  std::vector<RegionReading> readings_;
};

/// The columns, with the namespace of the sheet as the second one where options.sheets is set.
std::vector<TableColumn> withSheet(std::vector<TableColumn> columns, const StatisticsOptions& options);
/// The row, likewise.
std::vector<TableValue> withSheet(std::vector<TableValue> row, const std::string& sheet,
                                  const StatisticsOptions& options);

/// Name of a region in a table: that of the whole matrix is map::kWholeMatrix.
std::string regionName(const map::RegionStatistics& region);

}  // namespace fsr::exports
