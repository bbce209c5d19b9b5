#include <functional>
#include <type_traits>

#include "calibration/file/calibration_hdf5.h"
#include "compensation/training_statistics.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

// The rows of all cells, one cell after the other, as they are read.
struct Rows {
  std::vector<std::uint64_t> first = {0};  // index of the first row of each cell, and the number of rows
  std::vector<std::uint16_t> code;
  std::vector<std::uint32_t> count;
  std::vector<std::int64_t> sum;
  std::vector<std::int64_t> square_high;
  std::vector<std::uint64_t> square_low;
};

using Cells = std::vector<regression::CodeStatistics>;

// Index of the first row of each cell, and the number of rows.
std::vector<std::uint64_t> firstRows(const Cells& cells) {
  std::vector<std::uint64_t> first = {0};
  for (const regression::CodeStatistics& cell : cells) first.push_back(first.back() + cell.codes());
  return first;
}

// One value for each code that occurs more than once, of type T.
template <typename T>
std::vector<T> squaresOf(const regression::CodeStatistics& cell, int shift) {
  std::vector<T> values;
  values.reserve(cell.square().size());
  for (const regression::Int128 square : cell.square()) values.push_back(static_cast<T>(square >> shift));
  return values;
}

// The rows of all cells, one cell after the other.
void writeRows(const Cells& cells, hdf5::Writer& writer) {
  const std::vector<std::uint64_t> first = firstRows(cells);
  std::size_t repeated = 0;
  for (const regression::CodeStatistics& cell : cells) repeated += cell.square().size();
  writer.dataset("/statistics/first", first, {first.size()}, "",
                 "row where each cell [taxels x classes x sections] begins, and the number of rows");
  const auto write = [&](const char* name, auto column, std::size_t rows, const char* unit,
                         const char* meaning) {
    using Values = std::decay_t<decltype(column(cells.front()))>;
    const std::function<Values(std::size_t)> piece = [&](std::size_t cell) { return column(cells[cell]); };
    writer.dataset("/statistics/" + std::string(name), cells.size(), piece, {rows}, unit, meaning);
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

regression::Int128 squareAt(const Rows& rows, std::size_t i) {
  if (i >= rows.square_high.size()) throw settings::InputError("its /statistics/square_high ends too early");
  return regression::Int128{rows.square_high[i]} * (regression::Int128{1} << 64) + rows.square_low[i];
}

std::vector<regression::CodeStatistics> cellsOf(const Rows& rows) {
  std::vector<regression::CodeStatistics> cells(rows.first.size() - 1);
  std::size_t repeated = 0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (rows.first[cell] > rows.first[cell + 1] || rows.first[cell + 1] > rows.code.size()) {
      throw settings::InputError("its /statistics/first does not ascend to the number of rows");
    }
    for (std::size_t row = rows.first[cell]; row < rows.first[cell + 1]; ++row) {
      const regression::Int128 square =
          rows.count[row] > 1 ? squareAt(rows, repeated++) : regression::Int128{0};
      cells[cell].append({rows.code[row], rows.count[row], rows.sum[row], square});
    }
  }
  return cells;
}

constexpr std::size_t kMostSections = 1000;  // far more than training uses
constexpr char kConditions[] = "/statistics/conditions";

void writeConditions(const std::vector<dataset::RecordedCondition>& conditions, hdf5::Writer& writer) {
  std::vector<dataset::CurvatureClass> classes;
  std::vector<std::uint64_t> scans;
  for (const dataset::RecordedCondition& recorded : conditions) {
    classes.push_back(recorded.condition);
    scans.push_back(recorded.scans);
  }
  writer.group(kConditions);
  writeClasses(kConditions, classes, writer);
  writer.dataset(kConditions + std::string("/scans"), scans, {scans.size()}, "",
                 "of each condition of each bag, bag after bag: what the classes were pooled from");
}

// Files of the first version have none.
std::vector<dataset::RecordedCondition> readConditions(matrix::MatrixSize size, const hdf5::Reader& reader) {
  if (!reader.has(kConditions)) return {};
  std::vector<dataset::RecordedCondition> conditions;
  const std::vector<dataset::CurvatureClass> classes = readClasses(kConditions, size, reader);
  const auto scans = reader.dataset<std::uint64_t>(kConditions + std::string("/scans"), {classes.size()});
  for (std::size_t i = 0; i < classes.size(); ++i) conditions.push_back({classes[i], scans[i]});
  return conditions;
}

}  // namespace

void writeStatistics(const compensation::TrainingStatistics& statistics, hdf5::Writer& writer) {
  writer.group("/statistics");
  writeClasses("/statistics", statistics.classes, writer);
  writeConditions(statistics.conditions, writer);
  writer.attribute("/statistics", "taxels", statistics.taxels);
  writer.attribute("/statistics", "sections", statistics.sections);
  writeRows(statistics.cells, writer);
}

compensation::TrainingStatistics readStatistics(const hdf5::Reader& reader, matrix::MatrixSize size,
                                                bool cells) {
  compensation::TrainingStatistics statistics;
  statistics.classes = readClasses("/statistics", size, reader);
  statistics.taxels = reader.integer("/statistics", "taxels");
  statistics.sections = reader.integer("/statistics", "sections");
  const bool whole = statistics.taxels == size.taxels() || statistics.classes.empty();
  if (!whole || statistics.sections > kMostSections) {
    throw settings::InputError("its /statistics taxels or sections do not fit the matrix");
  }
  if (!cells) return statistics;
  Rows rows;
  const std::size_t number = size.taxels() * statistics.classes.size() * statistics.sections;
  rows.first = reader.dataset<std::uint64_t>("/statistics/first", {number + 1});
  rows.code = reader.dataset<std::uint16_t>("/statistics/code", {rows.first.back()});
  rows.count = reader.dataset<std::uint32_t>("/statistics/count", {rows.first.back()});
  rows.sum = reader.dataset<std::int64_t>("/statistics/sum", {rows.first.back()});
  const std::vector<std::size_t> squares = reader.shape("/statistics/square_high");
  rows.square_high = reader.dataset<std::int64_t>("/statistics/square_high", squares);
  rows.square_low = reader.dataset<std::uint64_t>("/statistics/square_low", squares);
  statistics.cells = cellsOf(rows);
  statistics.conditions = readConditions(size, reader);
  return statistics;
}

}  // namespace fsr::calibration
