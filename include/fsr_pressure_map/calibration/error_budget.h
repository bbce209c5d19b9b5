#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::calibration {

/// Where the number of a line comes from.
enum class BudgetSource {
  kMeasured,    ///< from the readings of this training
  kSession,     ///< the bags state it
  kDeclared,    ///< CalibrationOptions state it
  kNotAssessed  ///< nothing is known of it
};

/// Where a line stands in the combined uncertainty.
enum class BudgetPart {
  kHeldOut,  ///< inside the held-out error, which contains it
  kPartly,   ///< the held-out error contains a part; the rest is added
  kAdded,    ///< the held-out error does not contain it; it is added
  kAside     ///< holds for some readings only, or is not known; in no sum
};

/// The pressures at which a budget is stated: these shares of the trained range.
constexpr std::array<double, 3> kBudgetShares = {0.1, 0.5, 0.9};
/// One value for each of them [Pa]; NaN = not known there.
using BudgetValues = std::array<double, kBudgetShares.size()>;
constexpr BudgetValues kNoBudgetValues = {std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::quiet_NaN()};

/// One source of error.
struct BudgetLine {
  std::string name;  ///< e.g. "loading and unloading"
  BudgetSource source = BudgetSource::kNotAssessed;
  BudgetPart part = BudgetPart::kAside;
  BudgetValues standard = kNoBudgetValues;  ///< standard uncertainty [Pa]
  BudgetValues added = {};  ///< what the combined uncertainty has beyond the held-out error [Pa]
  std::string note;         ///< how it was found, or what is missing
};

/// The unit that is left out as a whole where the interval of a reading is found.
enum class IntervalUnit {
  kCycles,  ///< every surface was mounted once: the intervals hold for new cycles, not for a new mount
  kMounts
};

/// Share of the readings that an interval shall contain.
constexpr std::array<double, 2> kIntervalLevels = {0.6827, 0.95};

/// Intervals of readings within one bin of the map's pressure.
struct BinIntervals {
  std::uint64_t units = 0;  ///< with readings in the bin
  /// By kIntervalLevels: the interval is +- factor x deviation. NaN = the units are too few for the level.
  std::array<double, 2> factor = {std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::quiet_NaN()};
  /// Share of the readings of a unit within it, with the factor of the other units, mean over the units. NaN:
  /// the others alone are too few.
  std::array<double, 2> covered = factor;
};

/// One bin of the map's pressure in DeviationScale. NaN = not known.
struct BinScale {
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< its middle [Pa]; NaN = no readings
  double factor = std::numeric_limits<double>::quiet_NaN();    ///< NaN = the units are too few
  /// Share of the readings of a unit within one deviation of the tables, and within one of the map with the
  /// factors of the other units: means over the units.
  double within_tables = std::numeric_limits<double>::quiet_NaN();
  double within_map = std::numeric_limits<double>::quiet_NaN();
};

/// By what the deviation of the tables is multiplied to be that of the map, such that 68.27 % of the readings
/// of a new mount lie within one deviation. 1 where the units are cycles.
struct DeviationScale {
  std::array<BinScale, statistics::kPressureBins> bins;
  BinScale whole;  ///< only the shares

  /// Whether the deviation of the map differs from that of the tables.
  bool present() const;
  /// Linear between the middles of the bins with readings, constant beyond the outer ones; bins without a
  /// factor have 1. `pressure`: of the table [Pa].
  double at(double pressure) const;
};

/// Intervals of a reading, and how many readings they contained.
struct ErrorIntervals {
  IntervalUnit unit = IntervalUnit::kCycles;
  std::array<BinIntervals, statistics::kPressureBins> bins;
  BinIntervals whole;  ///< all pressures together
  /// By kIntervalLevels, with the factors of the bins: loading, unloading.
  std::array<std::array<double, 2>, 2> by_direction = {whole.factor, whole.factor};
  /// By kIntervalLevels, [taxels], with the factors of the bins; NaN = not known.
  std::array<std::vector<double>, 2> by_taxel;
  DeviationScale scale;

  bool present() const { return whole.units > 0; }
};

/// The uncertainty of a calibration, source by source.
struct ErrorBudget {
  BudgetValues pressure = kNoBudgetValues;  ///< where it is stated, gauge [Pa]
  /// Root mean square of the errors of held-out readings; each cycle, direction, taxel and surface has the
  /// same weight.
  BudgetValues held_out = kNoBudgetValues;
  std::vector<BudgetLine> lines;  ///< empty = no budget: scores were not computed
  /// Standard uncertainty: held_out and everything that is added, in quadrature. k = 2 doubles it.
  BudgetValues combined = kNoBudgetValues;
  ErrorIntervals intervals;

  bool present() const { return !lines.empty(); }
};

/// "measured here", "from the session", "declared", "not assessed".
std::string budgetSourceName(BudgetSource source);
/// "inside", "partly", "added", "aside".
std::string budgetPartName(BudgetPart part);

}  // namespace fsr::calibration
