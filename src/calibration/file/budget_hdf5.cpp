#include <cmath>
#include <limits>
#include <string>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/yaml_text.h"

namespace fsr::calibration {

namespace {

constexpr const char* kBudgetGroup = "/budget";
const std::string kBudgetPath = "/budget/";
constexpr const char* kIntervals = "/budget/intervals";
const std::string kIntervalPath = "/budget/intervals/";
constexpr const char* kCycles = "cycles";
constexpr const char* kMounts = "mounts";
constexpr std::size_t kPoints = kBudgetShares.size();
constexpr std::size_t kLevels = kIntervalLevels.size();
constexpr double kLargestFactor = 32;  // that of training: the edge of the last cell of IntervalTally
constexpr std::size_t kRows = statistics::kPressureBins + 1;  // the bins, then all pressures

std::vector<double> listOf(const BudgetValues& values) {
  return {values.begin(), values.end()};
}

BudgetValues valuesOf(const std::vector<double>& list, std::size_t line) {
  BudgetValues values;
  for (std::size_t p = 0; p < kPoints; ++p) values[p] = list[line * kPoints + p];
  return values;
}

const BinIntervals& rowOf(const ErrorIntervals& intervals, std::size_t row) {
  return row < statistics::kPressureBins ? intervals.bins[row] : intervals.whole;
}

void writeScale(const DeviationScale& scale, hdf5::Writer& writer) {
  std::vector<double> pressure, factor, covered;
  for (const BinScale& bin : scale.bins) {
    pressure.push_back(bin.pressure);
    factor.push_back(bin.factor);
    covered.insert(covered.end(), {bin.within_tables, bin.within_map});
  }
  covered.insert(covered.end(), {scale.whole.within_tables, scale.whole.within_map});
  writer.dataset(kIntervalPath + "scale_pressure", pressure, {statistics::kPressureBins}, "Pa",
                 "middle of each bin; NaN = no readings");
  writer.dataset(kIntervalPath + "scale_factor", factor, {statistics::kPressureBins}, "",
                 "the deviation of the map is that of /tables times this, linear between the middles of the "
                 "bins; NaN = too few units: 1");
  writer.dataset(kIntervalPath + "scale_covered", covered, {kRows, 2}, "",
                 "share of the readings of a unit within one deviation [row][of /tables, of the map with the "
                 "factors of the other units]");
}

void writeIntervals(const ErrorIntervals& intervals, hdf5::Writer& writer) {
  if (!intervals.present()) return;
  std::vector<std::uint64_t> units;
  std::vector<double> factor, covered, by_direction, by_taxel;
  for (std::size_t row = 0; row < kRows; ++row) {
    const BinIntervals& bin = rowOf(intervals, row);
    units.push_back(bin.units);
    factor.insert(factor.end(), bin.factor.begin(), bin.factor.end());
    covered.insert(covered.end(), bin.covered.begin(), bin.covered.end());
  }
  for (std::size_t level = 0; level < kLevels; ++level) {
    by_direction.insert(by_direction.end(), intervals.by_direction[level].begin(),
                        intervals.by_direction[level].end());
    by_taxel.insert(by_taxel.end(), intervals.by_taxel[level].begin(), intervals.by_taxel[level].end());
  }
  writer.group(kIntervals);
  writer.attribute(kIntervals, "meaning",
                   "pressure +- factor x deviation; rows are bins of 0, 50, 100, 200, 400 kPa and more, then "
                   "all pressures; columns are 68.27 % and 95 %; NaN = too few units");
  writer.attribute(kIntervals, "unit_left_out", intervals.unit == IntervalUnit::kMounts ? kMounts : kCycles);
  writer.dataset(kIntervalPath + "units", units, {kRows}, "", "units with readings");
  writer.dataset(kIntervalPath + "factor", factor, {kRows, kLevels}, "", "of the deviation");
  writer.dataset(kIntervalPath + "covered", covered, {kRows, kLevels}, "",
                 "share of the readings of a unit, with the factor of the others");
  writer.dataset(kIntervalPath + "by_direction", by_direction, {kLevels, 2}, "",
                 "share of the readings, [level][loading, unloading]");
  writer.dataset(kIntervalPath + "by_taxel", by_taxel, {kLevels, intervals.by_taxel[0].size()}, "",
                 "share of the readings, [level][taxel]");
  writeScale(intervals.scale, writer);
}

DeviationScale readScale(const hdf5::Reader& reader) {
  DeviationScale scale;
  if (!reader.has(kIntervalPath + "scale_factor")) return scale;
  const auto pressure = reader.dataset<double>(kIntervalPath + "scale_pressure", {statistics::kPressureBins});
  const auto factor = reader.dataset<double>(kIntervalPath + "scale_factor", {statistics::kPressureBins});
  const auto covered = reader.dataset<double>(kIntervalPath + "scale_covered", {kRows, 2});
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < kRows; ++row) {
    BinScale& bin = row < statistics::kPressureBins ? scale.bins[row] : scale.whole;
    bin.within_tables = covered[2 * row];
    bin.within_map = covered[2 * row + 1];
    if (row == statistics::kPressureBins) continue;
    bin.pressure = pressure[row];
    bin.factor = factor[row];
    if (!std::isnan(bin.factor) && !(bin.factor > 0 && bin.factor <= kLargestFactor)) {
      throw settings::InputError("its " + kIntervalPath + "scale_factor has " +
                                 settings::numberText(bin.factor) + " in bin " + std::to_string(row) +
                                 ", but must be above 0 and at most " + settings::numberText(kLargestFactor));
    }
    if (std::isnan(bin.pressure)) continue;
    if (!(bin.pressure > before) || std::isinf(bin.pressure)) {
      throw settings::InputError("its " + kIntervalPath + "scale_pressure has " +
                                 settings::numberText(bin.pressure) + " Pa in bin " + std::to_string(row) +
                                 ", but must rise from bin to bin");
    }
    before = bin.pressure;
  }
  return scale;
}

ErrorIntervals readIntervals(const hdf5::Reader& reader, matrix::MatrixSize size) {
  ErrorIntervals intervals;
  if (!reader.has(kIntervals)) return intervals;
  const std::string unit = reader.text(kIntervals, "unit_left_out");
  if (unit != kCycles && unit != kMounts) {
    throw settings::InputError("its " + std::string(kIntervals) + " leaves out \"" + unit +
                               "\", but must leave out cycles or mounts");
  }
  intervals.unit = unit == kMounts ? IntervalUnit::kMounts : IntervalUnit::kCycles;
  const auto units = reader.dataset<std::uint64_t>(kIntervalPath + "units", {kRows});
  const auto factor = reader.dataset<double>(kIntervalPath + "factor", {kRows, kLevels});
  const auto covered = reader.dataset<double>(kIntervalPath + "covered", {kRows, kLevels});
  const auto by_direction = reader.dataset<double>(kIntervalPath + "by_direction", {kLevels, 2});
  const auto by_taxel = reader.dataset<double>(kIntervalPath + "by_taxel", {kLevels, size.taxels()});
  for (std::size_t row = 0; row < kRows; ++row) {
    BinIntervals& bin = row < statistics::kPressureBins ? intervals.bins[row] : intervals.whole;
    bin.units = units[row];
    for (std::size_t level = 0; level < kLevels; ++level) {
      bin.factor[level] = factor[row * kLevels + level];
      bin.covered[level] = covered[row * kLevels + level];
    }
  }
  for (std::size_t level = 0; level < kLevels; ++level) {
    intervals.by_direction[level] = {by_direction[2 * level], by_direction[2 * level + 1]};
    const auto first = by_taxel.begin() + static_cast<std::ptrdiff_t>(level * size.taxels());
    intervals.by_taxel[level].assign(first, first + static_cast<std::ptrdiff_t>(size.taxels()));
  }
  intervals.scale = readScale(reader);
  return intervals;
}

// The value with this name; `values` are all that there are.
template <typename Value>
Value named(const std::string& name, const char* what, std::string (*nameOf)(Value),
            std::initializer_list<Value> values) {
  std::string names;
  for (const Value value : values) {
    if (nameOf(value) == name) return value;
    names += (names.empty() ? "" : ", ") + nameOf(value);
  }
  throw settings::InputError("its " + kBudgetPath + what + " has \"" + name + "\", but must be one of " +
                             names);
}

}  // namespace

void writeBudget(const ErrorBudget& budget, hdf5::Writer& writer) {
  if (!budget.present()) return;
  std::vector<std::string> names, sources, parts, notes;
  std::vector<double> standard, added;
  for (const BudgetLine& line : budget.lines) {
    names.push_back(line.name);
    sources.push_back(budgetSourceName(line.source));
    parts.push_back(budgetPartName(line.part));
    notes.push_back(line.note);
    standard.insert(standard.end(), line.standard.begin(), line.standard.end());
    added.insert(added.end(), line.added.begin(), line.added.end());
  }
  writer.group(kBudgetGroup);
  writer.attribute(
      kBudgetGroup, "meaning",
      "error budget: standard uncertainties, source by source, at 10, 50 and 90 % of the trained "
      "pressures; combined = held_out and what is added, in quadrature");
  writer.dataset(kBudgetPath + "pressure", listOf(budget.pressure), {kPoints}, "Pa", "gauge");
  writer.dataset(kBudgetPath + "held_out", listOf(budget.held_out), {kPoints}, "Pa",
                 "root mean square of the errors of held-out readings");
  writer.dataset(kBudgetPath + "combined", listOf(budget.combined), {kPoints}, "Pa", "k = 1");
  writer.texts(kBudgetPath + "names", names, "of the lines");
  writer.texts(kBudgetPath + "sources", sources, "where each number comes from");
  writer.texts(kBudgetPath + "parts", parts, "inside the held-out error, partly, added to it, or aside");
  writer.texts(kBudgetPath + "notes", notes, "how it was found, or what is missing");
  writer.dataset(kBudgetPath + "standard", standard, {names.size(), kPoints}, "Pa",
                 "standard uncertainty [line][pressure]; NaN = not known");
  writer.dataset(kBudgetPath + "added", added, {names.size(), kPoints}, "Pa",
                 "beyond the held-out error [line][pressure]");
  writeIntervals(budget.intervals, writer);
}

ErrorBudget readBudget(const hdf5::Reader& reader, matrix::MatrixSize size) {
  ErrorBudget budget;
  if (!reader.has(kBudgetGroup)) return budget;
  budget.pressure = valuesOf(reader.dataset<double>(kBudgetPath + "pressure", {kPoints}), 0);
  budget.held_out = valuesOf(reader.dataset<double>(kBudgetPath + "held_out", {kPoints}), 0);
  budget.combined = valuesOf(reader.dataset<double>(kBudgetPath + "combined", {kPoints}), 0);
  const std::vector<std::string> names = reader.texts(kBudgetPath + "names");
  const auto textsOf = [&](const char* what) {
    const std::vector<std::string> texts = reader.texts(kBudgetPath + what);
    if (texts.size() == names.size()) return texts;
    throw settings::InputError("its " + kBudgetPath + what + " does not have one text for each of " +
                               kBudgetPath + "names");
  };
  const std::vector<std::string> sources = textsOf("sources"), parts = textsOf("parts"),
                                 notes = textsOf("notes");
  const auto standard = reader.dataset<double>(kBudgetPath + "standard", {names.size(), kPoints});
  const auto added = reader.dataset<double>(kBudgetPath + "added", {names.size(), kPoints});
  for (std::size_t i = 0; i < names.size(); ++i) {
    budget.lines.push_back(
        {names[i],
         named(sources[i], "sources", budgetSourceName,
               {BudgetSource::kMeasured, BudgetSource::kSession, BudgetSource::kDeclared,
                BudgetSource::kNotAssessed}),
         named(parts[i], "parts", budgetPartName,
               {BudgetPart::kHeldOut, BudgetPart::kPartly, BudgetPart::kAdded, BudgetPart::kAside}),
         valuesOf(standard, i), valuesOf(added, i), notes[i]});
  }
  budget.intervals = readIntervals(reader, size);
  return budget;
}

}  // namespace fsr::calibration
