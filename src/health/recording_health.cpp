#include "health/recording_health.h"

#include <cmath>
#include <set>

#include "dataset/count_readers.h"

namespace fsr::health {

namespace {

constexpr double kOften = 0.01;  // of the scans

}  // namespace

RecordingHealth recordingHealth(const dataset::Recording& recording, const TaxelWatchOptions& options) {
  const matrix::MatrixSize size = recording.layout.size;
  const auto used = [&](std::size_t taxel) { return recording.mask.empty() || recording.mask[taxel] == 0; };
  RecordingHealth health;
  std::set<std::size_t> dead, stuck, rows, columns;
  std::vector<std::size_t> clipped(size.taxels(), 0);
  TaxelWatch watch(size, recording.full_scale, options);
  const auto failing = [&](std::size_t first, std::size_t count, std::size_t step) {
    std::size_t i = 0;
    while (i < count && (watch.flags()[first + i * step] & map::taxel_flag::kLineFault) != 0) ++i;
    return i == count;
  };
  dataset::ScanCounts scans(recording);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const std::uint16_t* const scan = scans[i];
    for (std::size_t t = 0; t < size.taxels(); ++t) {
      if (scan[t] < recording.full_scale || !used(t)) continue;
      ++clipped[t];
      if (!recording.pressure.empty())
        health.saturated_from = std::fmin(health.saturated_from, recording.pressure[i]);
    }
    if (!watch.observe(scan, recording.time[i])) continue;
    for (std::size_t t = 0; t < size.taxels(); ++t) {
      if (used(t) && (watch.flags()[t] & map::taxel_flag::kDead) != 0) dead.insert(t);
      if (used(t) && (watch.flags()[t] & map::taxel_flag::kStuck) != 0) stuck.insert(t);
    }
    for (std::size_t row = 0; row < size.rows; ++row)
      if (failing(row * size.columns, size.columns, 1)) rows.insert(row);
    for (std::size_t column = 0; column < size.columns; ++column)
      if (failing(column, size.rows, size.columns)) columns.insert(column);
  }
  double readings = 0, all = 0;
  for (std::size_t t = 0; t < size.taxels(); ++t) {
    if (!used(t)) continue;
    readings += double(recording.scans());
    all += double(clipped[t]);
    health.saturated_taxels += double(clipped[t]) > kOften * double(recording.scans());
  }
  if (readings > 0) health.saturated = all / readings;
  health.dead.assign(dead.begin(), dead.end());
  health.stuck.assign(stuck.begin(), stuck.end());
  health.rows.assign(rows.begin(), rows.end());
  health.columns.assign(columns.begin(), columns.end());
  return health;
}

}  // namespace fsr::health
