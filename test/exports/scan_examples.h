#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "exports/scan_formats.h"

namespace export_test {

/// A scan of 2 x 3 taxels with a map; taxel 4 is dead, taxel 5 saturated.
inline fsr::exports::ScanRecord exampleScan() {
  fsr::exports::ScanRecord scan;
  scan.stamp_ns = 1700000000123456789;
  scan.since_ns = 50000001;
  scan.layout = {{2, 3}, 0.010, 0.008};
  scan.sequence = 7;
  scan.full_scale = 4095;
  scan.counts = {0, 1, 2, 300, 17, 4095};
  scan.map.emplace();
  scan.map->reset(scan.layout);
  scan.map->state = fsr::map::MapState::kOk;
  scan.map->pressure = {0.1f, -14.892578f, 1e-30f, 123456.79f, std::nanf(""), 600000.06f};
  scan.map->deviation = {1.0f, 2.5f, 1.0f / 3, 4409.3486f, std::nanf(""), 5.0f};
  scan.map->flags = {0,
                     fsr::map::taxel_flag::kTared | fsr::map::taxel_flag::kBelowRange,
                     0,
                     0,
                     fsr::map::taxel_flag::kDead,
                     fsr::map::taxel_flag::kSaturated};
  scan.chamber_pressure = 100.1;
  scan.temperature = 23.5;
  fsr::matrix::Surface surface;
  surface.name = "cylinder_7cm";
  surface.mount = 3;
  surface.curvature = {{14.25, 0, 0}};
  scan.surface = std::make_shared<fsr::matrix::Surface>(surface);
  scan.session = "2026-03-01";
  scan.cycle = 2;
  scan.event = "note:wet, \"warm\"";
  return scan;
}

/// A scan with counts only.
inline fsr::exports::ScanRecord bareScan() {
  fsr::exports::ScanRecord scan;
  scan.stamp_ns = 1700000000223456789;
  scan.since_ns = 150000001;
  scan.layout = {{2, 3}};
  scan.full_scale = 4095;
  scan.counts = {9, 8, 7, 6, 5, 4};
  return scan;
}

inline fsr::exports::ExportSubject exampleSubject() {
  fsr::exports::ExportSubject subject;
  subject.name = "2_cylinder.bag";
  subject.maps = true;
  subject.model = "S5051";
  subject.calibration = "0123456789ab";
  subject.scheme = "interpolated";
  subject.trained_low = 0;
  subject.trained_high = 620000;
  return subject;
}

/// Opens an output of the format of this name.
inline std::unique_ptr<fsr::exports::ScanSink> opened(const std::string& format, const std::string& path,
                                                      const fsr::exports::StatisticsOptions& options = {}) {
  for (const fsr::exports::ScanFormat& known : fsr::exports::scanFormats()) {
    if (known.name == format) return known.open(path, options);
  }
  return nullptr;
}

/// Writes a recording in the format of this name.
inline void write(const std::string& format, const std::string& path,
                  const std::vector<fsr::exports::ScanRecord>& scans,
                  const fsr::exports::StatisticsOptions& options = {}, bool maps = true) {
  const auto sink = opened(format, path, options);
  fsr::exports::ExportSubject subject = exampleSubject();
  subject.maps = maps;
  sink->begin(subject);
  for (const fsr::exports::ScanRecord& scan : scans) sink->add(scan);
  sink->finish();
}

}  // namespace export_test
