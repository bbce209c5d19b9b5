#include "exports/scan_table.h"

#include <algorithm>

#include "exports/archive_layout.h"

namespace fsr::exports {

using hdf5::ColumnWriter;

using hdf5::ColumnPlan;

namespace {

ColumnPlan planOf(const std::string& name, hid_t type, const std::string& unit, const std::string& meaning) {
  ColumnPlan plan;
  plan.path = "/scans/" + name;
  plan.type = type;
  plan.unit = unit;
  plan.meaning = meaning;
  return plan;
}

std::int64_t rowOr(const std::optional<std::uint64_t>& row) {
  return row ? static_cast<std::int64_t>(*row) : -1;
}

}  // namespace

ScanTable::ScanTable(hid_t file, const std::string& path) : file_(file), path_(path) {
  archive::attempt(path_, [&] {
    lay("stamp", H5T_NATIVE_INT64, "ns", "time of the scan, since 1970, UTC");
    lay("time", H5T_NATIVE_DOUBLE, "s", "since the first scan");
    lay("raw", H5T_NATIVE_INT64, "", "row of the scan in the datasets of the topic raw; -1 = not recorded");
    lay("pressure_map", H5T_NATIVE_INT64, "", "row of its map in the datasets of pressure_map; -1 = none");
    lay("chamber_pressure", H5T_NATIVE_DOUBLE, "Pa", "gauge, interpolated to the scan; NaN = unknown");
    lay("temperature", H5T_NATIVE_DOUBLE, "degree Celsius", "interpolated to the scan; NaN = unknown");
    lay("cycle", H5T_NATIVE_UINT32, "", "cycle of the chamber's pressure, from 1; 0 = unknown");
    lay("mount", H5T_NATIVE_UINT32, "", "number of the mount; 0 = unknown");
    for (const char* name : {"surface", "session", "event"}) {
      const std::string meaning = std::string("row of /scans/") + name + "_names";
      labels_[name].column =
          std::make_unique<ColumnWriter>(file_, planOf(name, H5T_NATIVE_UINT32, "", meaning));
    }
  });
}

void ScanTable::lay(const char* name, hid_t type, const char* unit, const char* meaning) {
  columns_[name] = std::make_unique<ColumnWriter>(file_, planOf(name, type, unit, meaning));
}

template <typename T>
void ScanTable::put(const char* name, T value) {
  columns_.at(name)->append(&value, 1);
}

void ScanTable::label(const std::string& name, const std::string& text) {
  Labels& labels = labels_.at(name);
  const auto [found, is_new] = labels.row.emplace(text, static_cast<std::uint32_t>(labels.names.size()));
  if (is_new) labels.names.push_back(text);
  labels.column->append(&found->second, 1);
}

void ScanTable::add(const ScanRecord& scan) {
  archive::attempt(path_, [&] {
    put("stamp", scan.stamp_ns);
    put("time", 1e-9 * static_cast<double>(scan.since_ns));
    put("raw", rowOr(scan.raw_row));
    put("pressure_map", rowOr(scan.map_row));
    put("chamber_pressure", scan.chamber_pressure);
    put("temperature", scan.temperature);
    put("cycle", static_cast<std::uint32_t>(scan.cycle.value_or(0)));
    put("mount", scan.surface ? scan.surface->mount : 0u);
    label("surface", scan.surface ? scan.surface->name : "");
    label("session", scan.session);
    label("event", scan.event);
  });
}

void ScanTable::finish() {
  archive::attempt(path_, [&] {
    for (auto& column : columns_) column.second->finish();
    for (auto& [name, labels] : labels_) {
      labels.column->finish();
      ColumnPlan plan = planOf(name + "_names", 0, "", "\"\" = unknown");
      for (const std::string& text : labels.names) plan.text_size = std::max(plan.text_size, text.size());
      ColumnWriter names(file_, plan);
      for (const std::string& text : labels.names) names.appendText(text);
      names.finish();
    }
  });
}

}  // namespace fsr::exports
