#include "exports/scan_formats.h"

#include <filesystem>

#include "exports/csv_table.h"
#include "exports/scan_table.h"
#include "exports/tekscan_file.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::exports {

namespace {

template <typename Sink>
std::unique_ptr<ScanSink> opened(const std::string& output) {
  return std::make_unique<Sink>(output);
}

std::unique_ptr<ScanSink> openTekscan(const std::string& output) {
  if (std::filesystem::path(output).extension() == ".gz") {
    throw settings::InputError("--output is " + output + ", but only csv can be compressed");
  }
  return opened<TekscanFile>(output);
}

}  // namespace

const std::vector<ScanFormat>& scanFormats() {
  static const std::vector<ScanFormat> formats = {
      {"csv", "table with a row for each taxel and scan (.gz: compressed); takes several bags", true,
       opened<CsvTable>},
      {"hdf5", "datasets with an entry for each scan (h5py, MATLAB, R)", false, opened<ScanTable>},
      {"tekscan", "ASCII as Tekscan's I-Scan and F-Scan save it (*.asf)", false, openTekscan}};
  return formats;
}

}  // namespace fsr::exports
