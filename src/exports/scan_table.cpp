#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exports/hdf5_output.h"
#include "exports/scan_formats.h"
#include "hdf5/column.h"
#include "settings/replace_file.h"

namespace fsr::exports {

using hdf5::ColumnPlan;
using hdf5::ColumnWriter;

namespace {

constexpr char kGroup[] = "/scans";

std::string pathOf(const std::string& name) {
  return std::string(kGroup) + '/' + name;
}

double curvatureAt(const ScanRecord& scan, std::size_t taxel) {
  if (scan.surface == nullptr || !scan.surface->known()) return ScanRecord::kUnknown;
  return matrix::principalCurvature(scan.surface->at({taxel}));
}

// The scans of a recording as datasets of the group /scans of an HDF5 file, with one entry for each scan, in
// the order of their stamps. docs/exports.md describes them; the attributes `unit` and `meaning` of a
// dataset do so in the file.
class ScanTable : public ScanSink {
 public:
  explicit ScanTable(const std::string& path) : path_(path), fresh_(path) {}

  void begin(const ExportSubject& subject) override { subject_ = subject; }
  // Throws InputError if the size of the matrix has changed.
  void add(const ScanRecord& scan) override {
    if (!file_) attempt(path_, [&] { open(scan); });
    requireOneSize(subject_, size_, scan.layout.size, "datasets have");
    attempt(path_, [&] {
      put("stamp", scan.stamp_ns);
      put("time", 1e-9 * static_cast<double>(scan.since_ns));
      put("sequence", scan.sequence ? std::int64_t{*scan.sequence} : -1);
      putTaxels(scan);
      put("chamber_pressure", scan.chamber_pressure);
      put("temperature", scan.temperature);
      put("cycle", static_cast<std::uint32_t>(scan.cycle.value_or(0)));
      put("mount", scan.surface ? scan.surface->mount : 0u);
      label("surface", scan.surface ? scan.surface->name : "");
      label("session", scan.session);
      label("event", scan.event);
    });
  }

  void finish() override {
    if (!file_) throw settings::InputError(path_ + ": there is no scan to write; choose a longer interval");
    attempt(path_, [&] {
      for (auto& column : columns_) column.second->finish();
      for (const auto& [name, labels] : labels_) {
        ColumnPlan plan;
        plan.path = pathOf(name + "_names");
        plan.meaning = "\"\" = unknown";
        for (const std::string& text : labels.names) plan.text_size = std::max(plan.text_size, text.size());
        ColumnWriter names(*file_, plan);
        for (const std::string& text : labels.names) names.appendText(text);
        names.finish();
      }
      columns_.clear();
      closeFile(file_);
    });
    fresh_.finish();
  }

 private:
  // Texts that repeat: each is stored once, and the scans have its row.
  struct Labels {
    std::map<std::string, std::uint32_t> row;
    std::vector<std::string> names;
  };

  template <typename T>
  void put(const char* name, T value) {
    columns_.at(name)->append(&value, 1);
  }

  template <typename T>
  void putAll(const char* name, const std::vector<T>& values) {
    columns_.at(name)->append(values.data(), 1);
  }

  void putTaxels(const ScanRecord& scan) {
    const std::size_t taxels = size_.taxels();
    map::PressureMap none;
    none.reset(scan.layout);
    const map::PressureMap& map = scan.map ? *scan.map : none;
    std::vector<std::int32_t> counts(scan.counts.begin(), scan.counts.end());
    counts.resize(taxels, -1);
    std::vector<double> curvature(taxels);
    for (std::size_t i = 0; i < taxels; ++i) curvature[i] = curvatureAt(scan, i);
    putAll("counts", counts);
    putAll("pressure", map.pressure);
    putAll("deviation", map.deviation);
    putAll("flags", map.flags);
    putAll("curvature", curvature);
    put("state", scan.map ? static_cast<std::int32_t>(map.state) : -1);
  }

  void label(const char* name, const std::string& text) {
    Labels& labels = labels_[name];
    const auto [found, is_new] = labels.row.emplace(text, static_cast<std::uint32_t>(labels.names.size()));
    if (is_new) labels.names.push_back(text);
    put(name, found->second);
  }

  void lay(const char* name, hid_t type, const char* unit, const char* meaning, bool each_taxel = false) {
    ColumnPlan plan;
    plan.path = pathOf(name);
    plan.type = type;
    if (each_taxel) plan.shape = {size_.rows, size_.columns};
    plan.unit = unit;
    plan.meaning = meaning;
    columns_[name] = std::make_unique<ColumnWriter>(*file_, plan);
  }

  void open(const ScanRecord& first) {
    size_ = first.layout.size;
    createFile(fresh_.name(), kGroup, file_);
    lay("stamp", H5T_NATIVE_INT64, "ns", "time of the scan, since 1970, UTC");
    lay("time", H5T_NATIVE_DOUBLE, "s", "since the first scan");
    lay("sequence", H5T_NATIVE_INT64, "", "scan counter of the board; a gap means lost scans; -1 = unknown");
    lay("counts", H5T_NATIVE_INT32, "counts", "reading of the converter, never tared; -1 = not recorded",
        true);
    lay("pressure", H5T_NATIVE_FLOAT, "Pa", "gauge; NaN = no reading", true);
    lay("deviation", H5T_NATIVE_FLOAT, "Pa", "one standard deviation of a held-out reading", true);
    lay("flags", H5T_NATIVE_UINT16, "", "bits as in PressureMap.msg", true);
    lay("curvature", H5T_NATIVE_DOUBLE, "1/m", "principal curvature of largest magnitude; NaN = unknown",
        true);
    lay("state", H5T_NATIVE_INT32, "", "state of the map as in PressureMap.msg; -1 = no map");
    lay("chamber_pressure", H5T_NATIVE_DOUBLE, "Pa", "gauge, interpolated to the scan; NaN = unknown");
    lay("temperature", H5T_NATIVE_DOUBLE, "degree Celsius", "interpolated to the scan; NaN = unknown");
    lay("cycle", H5T_NATIVE_UINT32, "", "cycle of the chamber's pressure, from 1; 0 = unknown");
    lay("mount", H5T_NATIVE_UINT32, "", "number of the mount; 0 = unknown");
    lay("surface", H5T_NATIVE_UINT32, "", "row of /scans/surface_names");
    lay("session", H5T_NATIVE_UINT32, "", "row of /scans/session_names");
    lay("event", H5T_NATIVE_UINT32, "", "row of /scans/event_names");
    hdf5::setAttribute(*file_, kGroup, "bag", subject_.name);
    hdf5::setAttribute(*file_, kGroup, "sensor", subject_.sensor);
    hdf5::setAttribute(*file_, kGroup, "calibration", subject_.calibration);
    hdf5::setAttribute(*file_, kGroup, "scheme", subject_.scheme);
    hdf5::setAttribute(*file_, kGroup, "pitch_x", first.layout.pitch_x);
    hdf5::setAttribute(*file_, kGroup, "pitch_y", first.layout.pitch_y);
    hdf5::setAttribute(*file_, kGroup, "use", "research use, not for diagnosis or fitting decisions");
  }

  std::string path_;
  settings::FreshPath fresh_;
  ExportSubject subject_;
  matrix::MatrixSize size_;
  std::optional<hdf5::Handle> file_;
  std::map<std::string, std::unique_ptr<hdf5::ColumnWriter>> columns_;
  std::map<std::string, Labels> labels_;
};

}  // namespace

std::unique_ptr<ScanSink> openScanTable(const std::string& output, const StatisticsOptions& /*options*/) {
  return std::make_unique<ScanTable>(output);
}

}  // namespace fsr::exports
