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

/// An export format that takes the scans of a recording one after another.
struct ScanFormat {
  std::string name;                 ///< as users write it, e.g. "csv"
  std::string summary;              ///< one line for the help
  bool several_recordings = false;  ///< whether one output can hold several recordings
  /// Opens the output. Throws InputError if it cannot be written.
  std::function<std::unique_ptr<ScanSink>(const std::string& output, const StatisticsOptions& options)> open;
  bool several_sheets = false;  ///< whether it says which sheet a row is of
};

/// The formats of this package. `export` offers each of them; a new format needs an entry here and nothing
/// else outside its own file.
const std::vector<ScanFormat>& scanFormats();

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

/// Frames in the ASCII format of Tekscan's I-Scan and F-Scan (*.asf). A header of "KEY value" lines ends with
/// ASCII_DATA @@. Each frame has a line "Frame N" and one line for each row, with values separated by commas;
/// `B` means no sensel or no reading. The line "@@" ends the frames. Lines end with CR LF. Maps are in kPa
/// (UNITS kPa), recordings without maps in counts (UNITS RAW).
///
/// The format assumes evenly spaced frames. The true time of each frame is in lines "FRAME_TIME N seconds"
/// after the final "@@", which readers of the format ignore.
class TekscanFile : public ScanSink {
 public:
  explicit TekscanFile(const std::string& path) : path_(path), file_(path) {}

  void begin(const ExportSubject& subject) override { subject_ = subject; }
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  std::string header(const ScanRecord& first);
  void line(const std::string& key, const std::string& value, std::string& text) const;

  std::string path_;
  settings::FreshFile file_;
  ExportSubject subject_;
  matrix::Layout layout_;
  std::vector<std::int64_t> times_;  // of the frames, since the recording's first scan [ns]
  // Offsets in the header of numbers that are known only at the end [bytes].
  std::size_t end_frame_at_ = 0;
  std::size_t period_at_ = 0;
};

}  // namespace fsr::exports
