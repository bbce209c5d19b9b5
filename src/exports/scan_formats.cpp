#include "exports/scan_formats.h"

#include <filesystem>

#include "exports/row_table.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/regular_file.h"

namespace fsr::exports {

namespace {

template <typename Value>
std::string known(const std::optional<Value>& value) {
  return value ? std::to_string(*value) : kAbsent;
}

// The first columns of a row, which are the same for all taxels of a scan. tail() has the later ones.
std::string head(const ScanRecord& scan, const std::string& bag) {
  const bool mounted = scan.surface != nullptr && scan.surface->mount != 0;
  return bag + ',' + quotedCell(scan.session) + ',' +
         (scan.surface ? quotedCell(scan.surface->name) : kAbsent) + ',' +
         (mounted ? std::to_string(scan.surface->mount) : kAbsent) + ',' + known(scan.cycle) + ',' +
         quotedCell(scan.event) + ',' + secondsText(scan.since_ns) + ',' + known(scan.sequence) + ',';
}

std::string tail(const ScanRecord& scan) {
  return "," + (scan.map ? stateWord(scan.map->state) : std::string(kAbsent)) + ',' +
         exactText(scan.chamber_pressure) + ',' + exactText(scan.temperature) + ',';
}

std::string reading(const ScanRecord& scan, std::size_t taxel) {
  std::string text = scan.counts.empty() ? kAbsent : std::to_string(scan.counts[taxel]);
  if (!scan.map) return text + ",NA,NA,";
  return text + ',' + exactText(scan.map->pressure[taxel]) + ',' + exactText(scan.map->deviation[taxel]) +
         ',';
}

std::string curvature(const ScanRecord& scan, std::size_t taxel) {
  if (scan.surface == nullptr || !scan.surface->known()) return kAbsent;
  return exactText(matrix::principalCurvature(scan.surface->at({taxel})));
}

// A tidy long table with one row for each taxel and scan; several recordings follow each other. kCsvHeader
// has the columns with their units; docs/exports.md describes each. Unknown values are NA. Numbers read back
// as exactly the recorded ones. Texts with a comma or quotation mark are quoted. R reads the table with
// read.csv(), Octave and MATLAB with textscan(). If the path ends with .gz, the file is compressed.
class CsvTable : public ScanSink {
 public:
  explicit CsvTable(const std::string& path) : file_(path, settings::file_kind::kTable) {
    file_.write(std::string(kCsvHeader) + '\n');
  }

  void begin(const ExportSubject& subject) override { bag_ = quotedCell(subject.name); }

  void add(const ScanRecord& scan) override {
    const std::string first = head(scan, bag_);
    const std::string last = tail(scan);
    const std::string stamp = ',' + secondsText(scan.stamp_ns) + ',';
    row_.clear();
    for (std::size_t taxel = 0; taxel < scan.layout.size.taxels(); ++taxel) {
      row_ += first;
      row_ +=
          std::to_string(scan.layout.row({taxel})) + ',' + std::to_string(scan.layout.column({taxel})) + ',';
      const std::string flags = scan.map ? flagWords(scan.map->flags[taxel]) : kAbsent;
      row_ += reading(scan, taxel) + flags;
      row_ += last;
      row_ += curvature(scan, taxel) + stamp + flags + '\n';
    }
    file_.write(row_);
  }

  void finish() override { file_.finish(); }

 private:
  settings::FreshFile file_;
  std::string bag_;
  std::string row_;  // a member so that its memory is used again
};

std::unique_ptr<ScanSink> openCsv(const std::string& output, const StatisticsOptions& /*options*/) {
  return std::make_unique<CsvTable>(output);
}

// A file whose header is completed at its end.
template <OpenSink open>
std::unique_ptr<ScanSink> uncompressed(const std::string& output, const StatisticsOptions& options) {
  if (std::filesystem::path(output).extension() == ".gz")
    throw settings::InputError("--output is " + output + ", but only tables can be compressed");
  return open(output, options);
}

}  // namespace

const std::vector<ScanFormat>& scanFormats() {
  static const std::vector<ScanFormat> formats = {
      {"csv", "table with a row for each taxel and scan (.gz: compressed); takes several bags", true,
       openCsv},
      {"statistics", "table with a row for each region and scan: peak, mean, force, area (.h5: HDF5)", true,
       openStatistics, true},
      {"trial", "table with a row for each region of a recording, and of each step in it (.h5: HDF5)", true,
       openTrial, true},
      {"hdf5", "datasets with an entry for each scan (h5py, MATLAB, R)", false, openScanTable},
      {"tekscan", "ASCII as Tekscan's I-Scan and F-Scan save it (*.asf)", false, uncompressed<openTekscan>},
      {"pliance", "ASCII as novel's pliance saves it (*.asc); needs maps", false, uncompressed<openPliance>}};
  return formats;
}

}  // namespace fsr::exports
