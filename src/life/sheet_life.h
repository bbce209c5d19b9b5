#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "life/sheet_state.h"
#include "life/step_test.h"

namespace fsr::life {

struct LifeOptions {
  /// Surface from which gain, zero and noise are taken. Empty = the one that was recorded on most dates; of
  /// several, the one that was recorded first.
  std::string surface;
  /// Probability that a date without a change shows one in any column of its source.
  double level = 0.01;
};

/// All recordings of one day, or all calibrations: one row of the table. Values are means over its files.
struct Row {
  SheetState::Source source = SheetState::Source::kRecording;
  std::int64_t date_ns = 0;        ///< of its first file [ns]
  std::vector<std::string> files;  ///< in the order of time
  double gain = kUnknown, gain_scatter = kUnknown;
  double zero = kUnknown, noise = kUnknown;  ///< [counts]
  double temperature = kUnknown;             ///< [degree Celsius]
  double error = kUnknown;                   ///< of held-out readings [Pa]
  std::vector<std::size_t> dead, stuck;      ///< in any of its files, ascending
};

/// A column of numbers that is tested for sudden changes (testSteps()).
struct Column {
  std::string name;  ///< e.g. "gain"
  std::string unit;  ///< e.g. "counts"; empty = ratio
  SheetState::Source source = SheetState::Source::kRecording;
  std::vector<std::size_t> rows;  ///< index into SheetLife::rows of each value
  std::vector<double> values;     ///< NaN = not known
  StepTests tests;

  /// Number of values, and of those that were tested.
  std::size_t known() const;
  std::size_t tested() const;
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
/// the gain refers to. Throws InputError where the states are of two sheets or of two matrices, and where no
/// state has the surface of the options.
///
/// Each column is tested at `level` divided by the number of columns of its source that have values, so that
/// of a date at which nothing changed at most the share `level` shows a change (Bonferroni).
SheetLife lifeOf(std::vector<SheetState> states, const std::string& first, const LifeOptions& options = {});

}  // namespace fsr::life
