#include "health/recording_health.h"

#include <algorithm>
#include <cmath>

#include "dataset/count_readers.h"

namespace fsr::health {

namespace {

constexpr double kOften = 0.01;  // of the scans

bool masked(const dataset::Recording& recording, std::size_t taxel) {
  return !recording.mask.empty() && recording.mask[taxel] != 0;
}

void addOnce(std::vector<std::size_t>& list, std::size_t value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

// A line fault is a line whose taxels are all flagged.
void noteLines(const dataset::Recording& recording, const std::vector<std::uint16_t>& flags,
               RecordingHealth& health) {
  const matrix::MatrixSize size = recording.layout.size;
  const auto fails = [&](std::size_t row, std::size_t column) {
    return (flags[row * size.columns + column] & map::taxel_flag::kLineFault) != 0;
  };
  for (std::size_t row = 0; row < size.rows; ++row) {
    bool whole = true;
    for (std::size_t column = 0; column < size.columns; ++column) whole = whole && fails(row, column);
    if (whole) addOnce(health.rows, row);
  }
  for (std::size_t column = 0; column < size.columns; ++column) {
    bool whole = true;
    for (std::size_t row = 0; row < size.rows; ++row) whole = whole && fails(row, column);
    if (whole) addOnce(health.columns, column);
  }
}

void noteFaults(const dataset::Recording& recording, const std::vector<std::uint16_t>& flags,
                RecordingHealth& health) {
  for (std::size_t t = 0; t < flags.size(); ++t) {
    if (masked(recording, t)) continue;
    if ((flags[t] & map::taxel_flag::kDead) != 0) addOnce(health.dead, t);
    if ((flags[t] & map::taxel_flag::kStuck) != 0) addOnce(health.stuck, t);
  }
  noteLines(recording, flags, health);
}

void countClipping(const dataset::Recording& recording, RecordingHealth& health) {
  const std::size_t taxels = recording.layout.size.taxels();
  std::size_t readings = 0, clipped = 0;
  for (std::size_t t = 0; t < taxels; ++t) {
    if (masked(recording, t)) continue;
    std::size_t own = 0;
    dataset::TaxelCounts counts(recording, t);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (counts[i] < recording.full_scale) continue;
      ++own;
      if (!recording.pressure.empty()) {
        health.saturated_from = std::fmin(health.saturated_from, recording.pressure[i]);
      }
    }
    readings += recording.scans();
    clipped += own;
    health.saturated_taxels += double(own) > kOften * double(recording.scans());
  }
  health.saturated = readings > 0 ? double(clipped) / double(readings) : 0;
}

}  // namespace

RecordingHealth recordingHealth(const dataset::Recording& recording, const TaxelWatchOptions& options) {
  RecordingHealth health;
  countClipping(recording, health);
  TaxelWatch watch(recording.layout.size, recording.full_scale, options);
  dataset::ScanCounts counts(recording);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (watch.observe(counts[i], recording.time[i])) noteFaults(recording, watch.flags(), health);
  }
  for (auto* list : {&health.dead, &health.stuck, &health.rows, &health.columns}) {
    std::sort(list->begin(), list->end());
  }
  return health;
}

}  // namespace fsr::health
