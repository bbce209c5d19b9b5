#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

// The life of a sheet: its recordings and calibrations by date, and what changed suddenly.
namespace fsr::check {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A sheet on one surface. NaN = not known.
struct SurfaceState {
  std::string surface;
  /// Slope of what the first calibration answers over the true pressure, from 10 to 70 % of its range: mean
  /// of the taxels, and their standard deviation (ratio). 1.1 = the sheet reads 10 % more than on the date of
  /// the first calibration. The rest of the range is left to a sheet whose gain rises; below, preload and
  /// turn-on pressure bend the curve.
  double gain = kUnknown;
  double gain_scatter = kUnknown;
  double zero = kUnknown;   ///< reading of the sheet at rest, mean of the taxels [counts]
  double noise = kUnknown;  ///< standard deviation of a taxel's reading at rest, from one scan to the next
                            ///< [counts]
};

/// What one recording or one calibration tells about its sheet.
struct SheetState {
  bool calibration = false;  ///< or a recording
  std::string file;          ///< as the user shall read it
  std::string sheet;
  std::int64_t date_ns = 0;  ///< since 1970, UTC [ns]
  matrix::Layout layout;
  std::uint16_t full_scale = 0;
  std::vector<SurfaceState> surfaces;    ///< in the order of their first appearance
  std::vector<std::size_t> dead, stuck;  ///< taxels; of a calibration: dead = those without a model
  double temperature = kUnknown;         ///< mean [degree Celsius]
  double error = kUnknown;               ///< of a calibration: RMSE on held-out readings [Pa]
};

/// The name of a sheet: its serial number, else its sensor id, else "". Sheets of different names are never
/// mixed.
std::string sheetOf(const dataset::SensorIdentity& sensor);

/// What a recording tells. `first`: the first calibration of the sheet; null = there is none, and the gain is
/// not known. It is not known either on surfaces that `first` was not trained on. Zero and noise are those of
/// the rest at the start (calibration::restAtStart()); readings up to five deviations of this noise count as
/// dead. Taxels that are dead or stuck do not count in the gain. Without a chamber pressure only taxels and
/// temperature are known. Throws InputError where `first` is of another matrix or converter.
SheetState stateOf(const dataset::Recording& recording, const calibration::Calibration* first);

/// What a calibration tells. Throws InputError where `first` is of another matrix or converter, and where the
/// date of the calibration is none.
SheetState stateOf(const calibration::Calibration& calibration, const calibration::Calibration* first);

/// Nanoseconds since 1970 of a date such as 2026-03-01T12:00:00Z. Throws InputError.
std::int64_t dateOf(const std::string& iso);
/// "2026-03-01", UTC.
std::string dayText(std::int64_t date_ns);

// Why a value was not tested.
constexpr const char* kNoValue = "no value";      ///< it is NaN
constexpr const char* kTooFew = "too few dates";  ///< fewer than three before it: their scatter is not known
constexpr const char* kNoScatter =
    "no scatter";  ///< those before it lie on a line exactly, e.g. whole counts

/// One value of a course, compared with the values before it.
struct Step {
  std::string untested = kTooFew;  ///< why it was not tested; empty = it was
  double predicted = kUnknown;
  double half_width = kUnknown;  ///< of the prediction interval
  double p = kUnknown;           ///< two-sided
  bool changed = false;          ///< p < level
};

/// Which values of a course changed suddenly.
struct StepTests {
  std::vector<Step> steps;  ///< one for each value
  /// The comparison that a value will have which follows the last one after `next`, without that value: its
  /// half-width is the smallest sudden change that would be found there.
  Step next;
};

/// Tests each value y_k against the values before it. These are taken as a line in time with scatter,
///
///   y_i = a + b t_i + e_i,   e_i independent, normal, of one variance,
///
/// where b is slow wear or drift. With n the number of earlier values, t' their mean time and s^2 the
/// variance of their residuals,
///
///   (y_k - a^ - b^ t_k) / (s sqrt(1 + 1/n + (t_k - t')^2 / sum (t_i - t')^2))
///
/// has Student's t distribution with n - 2 degrees of freedom. y_k changed where its two-sided p is below
/// `level`. This is the prediction interval of regression (N. Draper, H. Smith, Applied Regression Analysis,
/// 1998, sec. 3.2; R: predict(lm(y ~ t), interval = "prediction")). A value that changed begins a new course,
/// without the values before it. If it kept their scatter, a false finding would bring others: it is most
/// likely where the scatter is underestimated.
///
/// Where the model holds, each test finds a change with a probability of at most `level`, whatever the number
/// of values: with few of them the interval is wide instead. An undetected change among the earlier values
/// widens it, too. `time` ascends; a y that is NaN is left out. `level`: in (0, 1). `next`: time from the
/// last value to the one that will follow.
StepTests testSteps(const std::vector<double>& time, const std::vector<double>& y, double level,
                    double next = 0);

struct LifeOptions {
  /// Surface from which gain, zero and noise are taken. Empty = the one that was recorded on most dates; of
  /// several, the one that was recorded first.
  std::string surface;
  /// Probability that a date without a change shows one in any column of its source.
  double level = 0.01;
};

/// All recordings of one day, or all calibrations: one row of the table. Values are means over its files.
struct Row : SurfaceState {
  bool calibration = false;              ///< or recordings
  std::int64_t date_ns = 0;              ///< of its first file [ns]
  std::vector<std::string> files;        ///< in the order of time
  double temperature = kUnknown;         ///< [degree Celsius]
  double error = kUnknown;               ///< of held-out readings [Pa]
  std::vector<std::size_t> dead, stuck;  ///< in any of its files, ascending
};

/// A column of numbers that is tested for sudden changes (testSteps()).
struct Column {
  std::string name;  ///< e.g. "gain"
  std::string unit;  ///< e.g. "counts"; empty = ratio
  bool calibration = false;
  std::vector<std::size_t> rows;  ///< index into SheetLife::rows of each value
  std::vector<double> values;     ///< NaN = not known
  StepTests tests;

  std::size_t tested() const;  ///< number of values that were tested
};

/// A taxel that is dead or stuck and was neither on an earlier date.
struct LostTaxel {
  std::size_t row = 0;  ///< of SheetLife::rows
  std::size_t taxel = 0;
  bool stuck = false;
};

/// One sheet by date.
struct SheetLife {
  std::string sheet;    ///< serial number or sensor id; may be empty
  std::string first;    ///< file of the first calibration; empty = there is none
  std::string surface;  ///< from which gain, zero and noise are; empty = no recording has one
  matrix::Layout layout;
  double level = 0;       ///< of each date and source, all columns together
  std::vector<Row> rows;  ///< by date; of one day recordings first
  std::vector<Column> columns;
  std::vector<LostTaxel> lost;

  /// Whether anything changed suddenly.
  bool changed() const;
};

/// The life of one sheet, from the states of its files in any order. `first`: file of the calibration that
/// the gain refers to. Throws InputError where no state has the surface of the options.
///
/// Each column is tested at `level` divided by the number of columns of its source that have values, so that
/// of a date at which nothing changed at most the share `level` shows a change (Bonferroni).
SheetLife lifeOf(std::vector<SheetState> states, const std::string& first, const LifeOptions& options = {});

}  // namespace fsr::check
