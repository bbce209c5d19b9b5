#include "discrepancy/samples/faults.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// Calls use(scan, sample) for the scans of a visit in order.
template <typename Use>
void eachScan(const Measured& measured, const Visit& visit, Use use) {
  std::size_t sample = visit.first;
  for (std::size_t scan = 0; scan < visit.last_scan - visit.first_scan; ++scan) {
    while (sample + 1 < visit.last && measured.first_scan[sample + 1] <= visit.first_scan + scan) ++sample;
    use(scan, sample);
  }
}

health::Sheet sheetOf(const Measured& measured) {
  health::Sheet sheet{measured.layout, measured.full_scale, {}, {}};
  for (const std::uint8_t used : measured.used) sheet.used.push_back(used != 0);
  for (const Visit& visit : measured.visits) {
    const dataset::Recording& recording = (*measured.recordings)[visit.recording];
    sheet.stays.push_back({&recording,
                           visit.first_scan,
                           visit.last_scan,
                           visit.curvature_class,
                           measured.time[visit.first] - recording.time[visit.first_scan],
                           {}});
    eachScan(measured, visit, [&](std::size_t, std::size_t sample) {
      sheet.stays.back().rising.push_back(measured.direction[sample] > 0);
    });
  }
  return sheet;
}

FaultyReadings readingsOf(const Measured& measured, const health::Faults& found) {
  FaultyReadings readings;
  std::size_t faulty = 0;
  for (const health::Fault& fault : found.faults) faulty += fault.taxels.size();
  std::map<long, std::pair<double, double>> bins;  // sum of squares, number of readings
  std::map<std::string, double> by_surface;
  for (std::size_t v = 0; v < measured.visits.size(); ++v) {
    eachScan(measured, measured.visits[v], [&](std::size_t scan, std::size_t sample) {
      const double square = found.squares.empty() ? 0 : double(found.squares[v][scan]);
      const auto taxels = static_cast<double>(measured.taxels());
      auto& bin =
          bins[static_cast<long>(std::max(0.0, measured.pressure[sample]) / thresholds::kPressureBin)];
      bin.first += square;
      bin.second += static_cast<double>(faulty);
      readings.square += square;
      readings.readings += taxels;
      by_surface[measured.visits[v].surface.name] += square;
      if (measured.cycles[measured.cycle[sample]].use != CycleUse::kHoldOut) return;
      readings.held_out += square;
      readings.held_out_readings += taxels;
    });
  }
  const auto rms = [](const auto& sums) { return sums.second > 0 ? std::sqrt(sums.first / sums.second) : 0; };
  double most = 0;
  for (const auto& [bin, sums] : bins) most = std::max(most, rms(sums));
  readings.pressure = {INFINITY, 0};
  for (const auto& [bin, sums] : bins) {
    if (sums.second == 0 || rms(sums) < thresholds::kPressureShows * most) continue;
    const double low = static_cast<double>(bin) * thresholds::kPressureBin;
    readings.pressure = {std::min(readings.pressure.low, low), low + thresholds::kPressureBin};
  }
  for (const auto& [surface, squares] : by_surface) {
    if (squares > 0.01 * readings.square) readings.conditions.push_back(surface);
  }
  if (readings.conditions.size() == by_surface.size()) readings.conditions.clear();
  return readings;
}

}  // namespace

double leastGap(const Measured& measured, const DiscrepancyOptions& options, bool slow) {
  if (!std::isnan(options.least_gap)) return options.least_gap;
  double least = options.least_gap_share * measured.range();
  if (slow) return least;
  for (const dataset::Recording& recording : *measured.recordings)
    least = std::max(least, recording.reference_error);
  return least;
}

Faults findFaults(const Measured& measured, const DiscrepancyOptions& options,
                  const health::FaultProgress& progress) {
  health::FaultOptions limits;
  limits.level = options.level;
  limits.least_error = leastGap(measured, options) / measured.range();
  const health::Faults found = health::findFaults(sheetOf(measured), limits, progress);
  return {found.faults, readingsOf(measured, found)};
}

const simulation::EffectInfo& effectOf(const health::Fault& fault) {
  using simulation::Detector;
  switch (fault.kind) {
    case health::FaultKind::kStuckTaxels:
      return simulation::foundBy(Detector::kStuckTaxels);
    case health::FaultKind::kDeadTaxels:
    case health::FaultKind::kFadingTaxels:
      return simulation::foundBy(Detector::kDeadTaxels);
    case health::FaultKind::kRow:
      return simulation::foundBy(Detector::kRowFaults);
    default:
      return simulation::foundBy(Detector::kColumnFaults);
  }
}

}  // namespace fsr::discrepancy
