#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "exports/scan_record.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "settings/replace_file.h"

namespace fsr::exports {

/// What the statistics by region are computed with.
struct StatisticsOptions {
  std::string regions;              ///< region file (map/region.h); empty = the whole matrix alone
  double contact_threshold = 10e3;  ///< a taxel is in contact from this pressure on [Pa]
  view::PressureUnit unit = view::PressureUnit::kKilopascal;  ///< of pressures in the table
  /// A step has at least this force on the whole matrix [N]; NaN = a tenth of its range above the lowest.
  double step_force = ScanRecord::kUnknown;
  double above = ScanRecord::kUnknown;  ///< pressure for the time above it [Pa]; NaN = none
  bool sheets = false;                  ///< whether the second column names the sheet
};

/// Opens the output of a format. Throws InputError if it cannot be written.
using OpenSink = std::unique_ptr<ScanSink>(const std::string& output, const StatisticsOptions& options);
OpenSink openPliance, openScanTable, openStatistics, openTekscan, openTrial;

/// An export format that takes the scans of a recording one after another.
struct ScanFormat {
  std::string name;                 ///< as users write it, e.g. "csv"
  std::string summary;              ///< one line for the help
  bool several_recordings = false;  ///< whether one output can hold several recordings
  std::function<OpenSink> open;
  bool several_sheets = false;  ///< whether it says which sheet a row is of
};

/// The formats of this package. `export` offers each of them; a new format needs an entry here and nothing
/// else outside its own file.
const std::vector<ScanFormat>& scanFormats();

/// The last column is no number, since Octave's textscan() would read NA at the end of a file as 0. `flags`
/// is what `taxel_flags` is. It stays until 0.3 (docs/stability.md); pandas has an attribute of that name.
constexpr char kCsvHeader[] =
    "bag,session,surface,mount,cycle,event,time_s,sequence,row,column,counts,pressure_Pa,deviation_Pa,flags,"
    "state,chamber_pressure_gauge_Pa,temperature_degC,curvature_per_m,stamp_s,taxel_flags";

}  // namespace fsr::exports
