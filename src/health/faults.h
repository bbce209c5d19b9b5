#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::health {

/// A stay of the sheet in one place: scans first .. last - 1 of a recording. All taxels are loaded alike.
struct Stay {
  const dataset::Recording* recording = nullptr;
  std::size_t first = 0, last = 0;
  std::size_t surface = 0;   ///< stays with the same number are on one curvature
  double offset = 0;         ///< of the recording's times [s]
  std::vector<bool> rising;  ///< of each scan: the pressure rises

  std::size_t scans() const { return last - first; }
  /// Since the first scan of the first recording [s].
  double time(std::size_t scan) const { return recording->time[first + scan] + offset; }
};

/// Recordings of one sheet.
struct Sheet {
  matrix::Layout layout;
  double full_scale = 0;  ///< [counts]
  std::vector<Stay> stays;
  std::vector<bool> used;  ///< of each taxel
};

enum class FaultKind { kStuckTaxels, kDeadTaxels, kFadingTaxels, kRow, kColumn };

/// A time in which a taxel fails. It goes on until the taxel has another reading.
struct TaxelSpell {
  std::size_t taxel = 0;    ///< row-major
  double from = 0, to = 0;  ///< since the first scan of the first recording [s]; to = INFINITY: goes on
  double reading = 0;       ///< median of its second half [counts]
};

/// Taxels or a line that fail.
struct Fault {
  FaultKind kind = FaultKind::kStuckTaxels;
  std::size_t line = 0;                          ///< index of the row or column, if a line fails
  std::vector<std::size_t> taxels;               ///< row-major
  double share = 0;                              ///< share of the scans that are faulty
  double depth = 0;                              ///< mean relative loss of the reading
  double longest = 0;                            ///< longest spell [s]
  std::vector<std::pair<double, double>> times;  ///< start and end of each spell, since the first scan [s]
  std::vector<double> depths;                    ///< mean relative loss in each of those
  std::vector<TaxelSpell> spells;                ///< of each of its taxels, unless a line fails
  double fades_over = 0;  ///< of taxels that fade: from the start until nothing is left [s]
  double p = 1;           ///< of its test, corrected for all taxels or lines

  bool isLine() const { return kind == FaultKind::kRow || kind == FaultKind::kColumn; }
};

struct Faults {
  std::vector<Fault> faults;  ///< at most one of each kind
  /// Squared errors of the failing readings, relative to the expected ones, summed over the taxels, [stays]
  /// [scans] [share of full scale, squared]. Empty without faults.
  std::vector<std::vector<float>> squares;
};

struct FaultOptions {
  double level = 0.01;         ///< of the tests
  double least_error = 0.002;  ///< rms error of a fault's taxels over all scans, as a share of their range
};

/// Is called with the share of the search that is done.
using FaultProgress = std::function<void(double share)>;

/// Searches every scan for faults, in the readings relative to those of the other taxels. What changes all
/// taxels alike is therefore no fault of any.
///
/// A taxel fails where its largest mean deviation over some scans is an outlier among those of all taxels. A
/// line fails where its largest step from one scan to the next is one: the median deviation of its taxels
/// less that of the lines beside it, in units of a single taxel's noise, among the steps of the taxels that
/// are not in the line. The logarithms follow Gumbel's distribution (E. Gumbel, Statistics of extremes,
/// 1958), whose parameters are the median and the quartiles over the taxels. A line also fails where all its
/// taxels fail at the same time.
///
/// A failing taxel is named only where the rule of TaxelWatch (verdictOf()) calls it dead or stuck in its
/// spells, with what is expected of it in place of its neighbours, or where it fades: its gain falls from part
/// to part of each stay, or in the course of each spell. A reading that follows less than kResponds of a load
/// that came and went counts as kept.
Faults findFaults(const Sheet& sheet, const FaultOptions& options = {}, const FaultProgress& progress = {});

}  // namespace fsr::health
