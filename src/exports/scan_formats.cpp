#include "exports/scan_formats.h"

#include <filesystem>

#include "exports/pliance_file.h"
#include "exports/region_readings.h"
#include "exports/row_table.h"
#include "exports/scan_table.h"
#include "exports/trial_table.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/regular_file.h"

namespace fsr::exports {

namespace {

template <typename Sink>
std::unique_ptr<ScanSink> opened(const std::string& output, const StatisticsOptions&) {
  return std::make_unique<Sink>(output);
}

template <typename Sink>
std::unique_ptr<ScanSink> withOptions(const std::string& output, const StatisticsOptions& options) {
  return std::make_unique<Sink>(output, options);
}

// Of a file whose header is completed at its end.
void requireUncompressed(const std::string& output) {
  if (std::filesystem::path(output).extension() == ".gz")
    throw settings::InputError("--output is " + output + ", but only tables can be compressed");
}

std::unique_ptr<ScanSink> openTekscan(const std::string& output, const StatisticsOptions& options) {
  requireUncompressed(output);
  return opened<TekscanFile>(output, options);
}

std::unique_ptr<ScanSink> openPliance(const std::string& output, const StatisticsOptions& options) {
  requireUncompressed(output);
  return withOptions<PlianceFile>(output, options);
}

}  // namespace

const std::vector<ScanFormat>& scanFormats() {
  static const std::vector<ScanFormat> formats = {
      {"csv", "table with a row for each taxel and scan (.gz: compressed); takes several bags", true,
       opened<CsvTable>},
      {"statistics", "table with a row for each region and scan: peak, mean, force, area (.h5: HDF5)", true,
       withOptions<StatisticsTable>, true},
      {"trial", "table with a row for each region of a recording, and of each step in it (.h5: HDF5)", true,
       withOptions<TrialTable>, true},
      {"hdf5", "datasets with an entry for each scan (h5py, MATLAB, R)", false, opened<ScanTable>},
      {"tekscan", "ASCII as Tekscan's I-Scan and F-Scan save it (*.asf)", false, openTekscan},
      {"pliance", "ASCII as novel's pliance saves it (*.asc); needs maps", false, openPliance}};
  return formats;
}

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

}  // namespace

CsvTable::CsvTable(const std::string& path) : file_(path, settings::file_kind::kTable) {
  file_.write(std::string(kCsvHeader) + '\n');
}

void CsvTable::begin(const ExportSubject& subject) {
  bag_ = quotedCell(subject.name);
}

void CsvTable::add(const ScanRecord& scan) {
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

void CsvTable::finish() {
  file_.finish();
}

}  // namespace fsr::exports
