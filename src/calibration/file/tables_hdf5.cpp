#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

#include "calibration/file/calibration_hdf5.h"
#include "compensation/training_statistics.h"

// The tables and the sums behind them. They are large, so they are written taxel by taxel and cell by cell.
namespace fsr::calibration {

// The group is the one that has the classes.
void classesMembers(hdf5::Members& file, std::vector<dataset::CurvatureClass>& classes, std::size_t taxels) {
  file.texts("surfaces", classes, &dataset::CurvatureClass::surface,
             "names of the conditions, one for each class");
  std::size_t values = 1;
  for (const dataset::CurvatureClass& one : classes) values = std::max(values, one.curvature.size());
  std::vector<double> curvature;
  for (const dataset::CurvatureClass& one : classes) {
    for (std::size_t taxel = 0; !file.reads() && taxel < values; ++taxel) curvature.push_back(one.at(taxel));
  }
  hdf5::Shape shape = {classes.size(), values};
  if (file.reads()) shape = file.reader().shape(file.path("curvature"));
  file.require(shape.size() == 2 && shape[0] == classes.size() && (shape[1] == 1 || shape[1] == taxels),
               "curvature", "does not fit its surfaces and the matrix");
  file.dataset("curvature", curvature, shape, "1/m",
               "principal curvature of each class, one for all taxels or one each");
  if (!file.reads()) return;
  const auto finite = [](double value) { return std::isfinite(value); };
  file.require(std::all_of(curvature.begin(), curvature.end(), finite), "curvature", "is not finite");
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const auto row = curvature.begin() + static_cast<std::ptrdiff_t>(c * shape[1]);
    classes[c].curvature.assign(row, row + static_cast<std::ptrdiff_t>(shape[1]));
    const std::vector<double>& all = classes[c].curvature;
    if (std::all_of(all.begin(), all.end(), [&](double value) { return value == all[0]; }))
      classes[c].curvature.resize(1);
  }
}

namespace {

using Column = std::vector<float> regression::CodeTable::*;

void tableColumn(hdf5::Members& file, const char* name, compensation::CurvatureTables& tables, Column column,
                 const char* unit, const char* meaning) {
  const hdf5::Shape shape = {tables.size.taxels(), tables.classes.size(), tables.full_scale + 1u};
  if (file.reads()) {
    const std::vector<float> values = file.reader().dataset<float>(file.path(name), shape);
    auto first = values.begin();
    for (regression::CodeTable& table : tables.tables) {
      const auto last = first + static_cast<std::ptrdiff_t>(shape[2]);
      (table.*column).assign(first, last);
      first = last;
    }
    return;
  }
  const std::function<std::vector<float>(std::size_t)> of_taxel = [&](std::size_t taxel) {
    std::vector<float> values;
    values.reserve(shape[1] * shape[2]);
    for (std::size_t model = 0; model < shape[1]; ++model) {
      const std::vector<float>& own = tables.tables[taxel * shape[1] + model].*column;
      values.insert(values.end(), own.begin(), own.end());
    }
    return values;
  };
  file.writer().dataset(file.path(name), shape[0], of_taxel, shape, unit, meaning);
}

}  // namespace

void tablesMembers(hdf5::Members& file, compensation::CurvatureTables& tables) {
  const std::size_t taxels = tables.size.taxels();
  file.group("/tables");
  classesMembers(file, tables.classes, taxels);
  file.attribute("class_tolerance", tables.class_tolerance);
  file.note("class_tolerance_unit", "1/m");
  if (file.reads()) tables.tables.resize(taxels * tables.classes.size());
  tableColumn(file, "pressure", tables, &regression::CodeTable::pressure, "Pa",
              "[taxels x models x codes], gauge pressure of each reading; NaN = no model");
  tableColumn(file, "deviation", tables, &regression::CodeTable::deviation, "Pa",
              "one standard deviation of a held-out reading, likewise");
  tableColumn(file, "support", tables, &regression::CodeTable::support, "",
              "effective number of training samples, likewise");
  file.rows<std::uint16_t>(
      "trained_codes", tables.tables,
      [](regression::CodeTable& table) { return std::tie(table.lowest, table.highest); },
      {taxels, tables.classes.size(), 2}, "counts", "smallest and largest reading of training");
}

namespace {

using Cells = std::vector<regression::CodeStatistics>;

// One value for each code that occurs more than once, of type T.
template <typename T>
std::vector<T> squaresOf(const regression::CodeStatistics& cell, int shift) {
  std::vector<T> values;
  values.reserve(cell.square().size());
  for (const regression::Int128 square : cell.square()) values.push_back(static_cast<T>(square >> shift));
  return values;
}

// The rows of all cells, one cell after the other.
void writeRows(const Cells& cells, hdf5::Members& file) {
  std::vector<std::uint64_t> first = {0};  // row of each cell, and the number of rows
  std::size_t repeated = 0;
  for (const regression::CodeStatistics& cell : cells) {
    first.push_back(first.back() + cell.codes());
    repeated += cell.square().size();
  }
  file.dataset("first", first, {first.size()}, "",
               "row where each cell [taxels x classes x sections] begins, and the number of rows");
  const auto write = [&](const char* name, auto column, std::size_t rows, const char* unit,
                         const char* meaning) {
    using Values = std::decay_t<decltype(column(cells.front()))>;
    const std::function<Values(std::size_t)> piece = [&](std::size_t cell) { return column(cells[cell]); };
    file.writer().dataset(file.path(name), cells.size(), piece, {rows}, unit, meaning);
  };
  using Cell = const regression::CodeStatistics&;
  write(
      "code", [](Cell cell) { return cell.code(); }, first.back(), "counts", "reading, ascending in a cell");
  write(
      "count", [](Cell cell) { return cell.count(); }, first.back(), "", "scans with this reading");
  write(
      "sum", [](Cell cell) { return cell.sum(); }, first.back(), "2^-20 Pa",
      "sum of their chamber pressures, gauge");
  write(
      "square_high", [](Cell cell) { return squaresOf<std::int64_t>(cell, 64); }, repeated, "2^24 Pa^2",
      "sum of their squares, upper 64 bits, of the rows with count > 1");
  write(
      "square_low", [](Cell cell) { return squaresOf<std::uint64_t>(cell, 0); }, repeated, "2^-40 Pa^2",
      "lower 64 bits, likewise");
}

Cells readRows(const hdf5::Members& file, std::size_t cells) {
  const auto column = [&](auto type, const char* name, const hdf5::Shape& shape) {
    return file.reader().dataset<decltype(type)>(file.path(name), shape);
  };
  const auto first = column(std::uint64_t{}, "first", {cells + 1});
  const std::size_t rows = first.back();
  const auto code = column(std::uint16_t{}, "code", {rows});
  const auto count = column(std::uint32_t{}, "count", {rows});
  const auto sum = column(std::int64_t{}, "sum", {rows});
  const hdf5::Shape squares = file.reader().shape(file.path("square_high"));
  const auto high = column(std::int64_t{}, "square_high", squares);
  const auto low = column(std::uint64_t{}, "square_low", squares);
  Cells read(cells);
  std::size_t repeated = 0;
  const auto square = [&](std::size_t row) {
    if (count[row] <= 1) return regression::Int128{0};
    if (repeated >= high.size()) file.refuse("square_high", "ends too early");
    const std::size_t at = repeated++;
    return regression::Int128{high[at]} * (regression::Int128{1} << 64) + low[at];
  };
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (first[cell] > first[cell + 1] || first[cell + 1] > rows)
      file.refuse("first", "does not ascend to the number of rows");
    for (std::size_t row = first[cell]; row < first[cell + 1]; ++row)
      read[cell].append({code[row], count[row], sum[row], square(row)});
  }
  return read;
}

// Files of the first version have none.
void conditionsMembers(hdf5::Members file, std::vector<dataset::RecordedCondition>& conditions,
                       std::size_t taxels) {
  if (!file.group("/statistics/conditions")) return;
  std::vector<dataset::CurvatureClass> classes;
  for (const dataset::RecordedCondition& recorded : conditions) classes.push_back(recorded.condition);
  classesMembers(file, classes, taxels);
  conditions.resize(classes.size());
  for (std::size_t i = 0; i < classes.size(); ++i) conditions[i].condition = classes[i];
  file.rows<std::uint64_t>("scans", conditions, &dataset::RecordedCondition::scans, {conditions.size()}, "",
                           "of each condition of each bag, bag after bag: what the classes were pooled from");
}

}  // namespace

void statisticsMembers(hdf5::Members& file, compensation::TrainingStatistics& statistics, std::size_t taxels,
                       bool cells) {
  constexpr std::size_t kMostSections = 1000;  // far more than training uses
  file.group("/statistics");
  classesMembers(file, statistics.classes, taxels);
  if (!file.reads() || cells) conditionsMembers(file, statistics.conditions, taxels);
  file.attribute("taxels", statistics.taxels);
  file.attribute("sections", statistics.sections);
  if (!file.reads()) return writeRows(statistics.cells, file);
  const bool whole = statistics.taxels == taxels || statistics.classes.empty();
  file.require(whole && statistics.sections <= kMostSections, "taxels", "or sections do not fit the matrix");
  if (cells) statistics.cells = readRows(file, taxels * statistics.classes.size() * statistics.sections);
}

}  // namespace fsr::calibration
