#include "fsr_pressure_map/health/taxel_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "health/reading_rule.h"

namespace fsr::health {

namespace {

constexpr std::uint16_t kVerdict = map::taxel_flag::kDead | map::taxel_flag::kStuck;
constexpr std::uint16_t kHighestCode = 65535;

std::uint16_t codes(double share, std::uint16_t full_scale) {
  return static_cast<std::uint16_t>(std::lround(share * full_scale));
}

}  // namespace

TaxelWatch::TaxelWatch(matrix::MatrixSize size, std::uint16_t full_scale, const TaxelWatchOptions& options)
    : size_(size),
      full_scale_(full_scale),
      options_(options),
      floor_(codes(options.floor_share, full_scale)),
      loaded_(codes(options.loaded_share, full_scale)),
      travel_(codes(options.travel_share, full_scale)),
      next_row_(size.rows),
      flags_(size.taxels(), 0),
      evidence_(size.taxels(), 0),
      in_line_(size.taxels(), 0) {
  for (Window* window : {&current_, &closed_}) {
    window->low.resize(size.taxels());
    window->high.resize(size.taxels());
  }
}

void TaxelWatch::setNoise(double deviation) noexcept {
  constexpr double kBeyondNoise = 5;  // of normal noise, one reading in 3.5 million is further above
  const double least = codes(options_.floor_share, full_scale_);
  const double most = std::max(least, travel_ / 2.0);
  const double floor = std::ceil(kBeyondNoise * deviation);
  floor_ = static_cast<std::uint16_t>(floor > least ? std::min(floor, most) : least);
}

bool TaxelWatch::observe(const std::uint16_t* counts, double time) noexcept {
  if (scans_ == 0 || time < start_) open(time);
  const bool judged = next_row_ == size_.rows;
  if (judged && time - start_ >= options_.window && scans_ >= options_.least_scans) {
    std::swap(current_, closed_);
    next_row_ = 0;
    open(time);
  }
  widen(counts);
  ++scans_;
  // One row per scan, so that no scan costs much more than the others.
  if (next_row_ == size_.rows) return false;
  const bool changed = judgeRow(next_row_++);
  return (next_row_ == size_.rows && judgeLines()) || changed;
}

void TaxelWatch::open(double time) noexcept {
  std::fill(current_.low.begin(), current_.low.end(), kHighestCode);
  std::fill(current_.high.begin(), current_.high.end(), std::uint16_t{0});
  start_ = time;
  scans_ = 0;
}

void TaxelWatch::widen(const std::uint16_t* counts) noexcept {
  const std::size_t n = size_.taxels();
  std::uint16_t* low = current_.low.data();
  std::uint16_t* high = current_.high.data();
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t code = counts[i];
    low[i] = std::min(low[i], code);
    high[i] = std::max(high[i], code);
  }
}

bool TaxelWatch::judgeRow(std::uint16_t row) noexcept {
  bool changed = false;
  for (std::uint16_t column = 0; column < size_.columns; ++column) changed |= judge(row, column);
  return changed;
}

bool TaxelWatch::judge(std::uint16_t row, std::uint16_t column) noexcept {
  const std::size_t taxel = std::size_t{row} * size_.columns + column;
  const Neighbours around = neighbours(row, column);
  if (around.count == 0) return false;
  noteFullScale(taxel, around);
  const Stretch window{double(closed_.low[taxel]), double(closed_.high[taxel]), double(floor_), 0,
                       double(full_scale_)};
  const bool shorted = evidence_[taxel] == (kLoadSeen | kRestSeen);
  const auto verdictBy = [&](int neighbours) {
    return verdictOf(window, {around.loaded >= neighbours, around.moved >= neighbours, shorted});
  };
  const std::uint16_t before = flags_[taxel] & kVerdict;
  const std::uint16_t verdict = verdictBy(around.needed).value_or(before);
  in_line_[taxel] = verdictBy(around.count / 2 + 1).value_or(0);
  if (verdict == before) return false;
  if (verdict == 0) ++revivals_;
  flags_[taxel] = verdict;
  return true;
}

void TaxelWatch::noteFullScale(std::size_t taxel, const Neighbours& around) noexcept {
  std::uint8_t& evidence = evidence_[taxel];
  if (closed_.low[taxel] != full_scale_)
    evidence = 0;
  else {
    if (2 * around.loaded > around.count) evidence |= kLoadSeen;
    if (around.rested == around.count) evidence |= kRestSeen;
  }
}

bool TaxelWatch::judgeLines() noexcept {
  for (std::uint16_t& flags : flags_) flags &= static_cast<std::uint16_t>(~map::taxel_flag::kLineFault);
  bool found = false;
  const std::size_t rows = size_.rows, columns = size_.columns;
  for (std::size_t row = 0; row < rows; ++row)
    found |= judgeLine({row * columns, columns, 1, columns, row > 0, row + 1 < rows});
  for (std::size_t column = 0; column < columns; ++column)
    found |= judgeLine({column, rows, columns, 1, column > 0, column + 1 < columns});
  return std::exchange(line_fault_, found) || found;
}

// Flags a line that is dead, stuck or shorted as a whole.
bool TaxelWatch::judgeLine(const Line& line) noexcept {
  const bool outermost = !line.has_before || !line.has_behind;
  bool shorted = line.has_before || line.has_behind;
  std::uint16_t verdict = line.count > 1 ? kVerdict : std::uint16_t{0};
  for (std::size_t taxel = line.first, i = 0; i < line.count; ++i, taxel += line.step) {
    verdict &= static_cast<std::uint16_t>(flags_[taxel] | (outermost ? in_line_[taxel] : 0));
    shorted = shorted && closed_.low[taxel] == full_scale_ &&
              !(line.has_before && closed_.high[taxel - line.beside] >= travel_) &&
              !(line.has_behind && closed_.high[taxel + line.beside] >= travel_);
  }
  if (verdict == 0 && shorted && line.count > 1) verdict = map::taxel_flag::kStuck;
  if (verdict == 0) return false;
  for (std::size_t i = 0; i < line.count; ++i)
    flags_[line.first + i * line.step] |= static_cast<std::uint16_t>(verdict | map::taxel_flag::kLineFault);
  return true;
}

TaxelWatch::Neighbours TaxelWatch::neighbours(std::uint16_t row, std::uint16_t column) const noexcept {
  Neighbours result;
  const int last_row = std::min(row + 1, size_.rows - 1);
  const int last_column = std::min(column + 1, size_.columns - 1);
  for (int r = std::max(row - 1, 0); r <= last_row; ++r) {
    for (int c = std::max(column - 1, 0); c <= last_column; ++c) {
      if (r == row && c == column) continue;
      const std::size_t taxel = std::size_t(r) * size_.columns + std::size_t(c);
      ++result.count;
      result.loaded += closed_.high[taxel] >= loaded_;
      result.rested += closed_.low[taxel] < travel_;
      result.moved += closed_.high[taxel] - closed_.low[taxel] >= travel_;
    }
  }
  const bool inside = result.count == 8;
  result.needed = inside ? 5 : std::min(result.count, result.count / 2 + 2);
  return result;
}

}  // namespace fsr::health
