#include "dataset/table_recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>

#include "dataset/time_series.h"

namespace fsr::dataset {

namespace {

constexpr double kLargestValue = 1e15;   // larger than any sensor's, in any unit
constexpr double kLatestTime = 4e9;      // [s]: fits 64 bits of nanoseconds, added to the year 2000
constexpr double kYear2000 = 946684800;  // [s] since 1970; a later first time is a Unix time

// A column of the plan and its index in the table.
struct Source {
  std::size_t column;
  TableUnit unit;
};

// One row in SI units.
struct Row {
  double time = 0;                    // [s]
  std::vector<double> readings;       // counts, [V] or [S]
  std::optional<double> pressure;     // gauge [Pa]
  std::optional<double> temperature;  // [degree Celsius]
  matrix::Surface surface;
};

double roundNumberAbove(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0, 10.0}) {
    if (step * decade >= value) return step * decade;
  }
  return value;
}

class Reader {
 public:
  Reader(const std::string& path, const TablePlan& plan)
      : table_(path, plan.format), path_(path), plan_(plan) {
    for (const TableColumn& column : plan.columns) {
      const TableUnit unit = unitOf(column);
      if (column.role == ColumnRole::kReading) {
        for (const std::size_t each : table_.findAll(column.column))
          readings_.emplace_back(column.role, Source{each, unit});
      } else {
        others_.emplace_back(column.role, Source{table_.find(column.column), unit});
      }
    }
    for (const auto& [role, source] : readings_) {
      if (source.unit.quantity == quantity()) continue;
      throw settings::InputError(path + ": readings are in " + quantity() + " and in " +
                                 source.unit.quantity + ", but must be of one kind");
    }
    own_reference_ =
        has(ColumnRole::kReferenceTime) || plan.reference_rate.has_value() || plan.reference_offset != 0;
    requireReference();
    if (plan.matrix.taxels() == 0 && readings_.size() > matrix::kMaxMatrixSide) {
      throw settings::InputError(
          path + ": --columns names " + std::to_string(readings_.size()) +
          " readings, more than a row of a matrix can have; give --matrix ROWSxCOLUMNS");
    }
    size_ = plan.matrix.taxels() > 0 ? plan.matrix
                                     : matrix::MatrixSize{1, static_cast<std::uint16_t>(readings_.size())};
    if (size_.taxels() != readings_.size()) {
      throw settings::InputError(path + ": --columns names " + std::to_string(readings_.size()) +
                                 " readings, but --matrix is " + matrix::sizeText(size_));
    }
  }

  TableRecording read();

 private:
  const std::string& quantity() const { return readings_.front().second.unit.quantity; }
  bool nextRow(TableRecording& result);
  void requireReference() const;
  bool has(ColumnRole role) const;
  const Source& sourceOf(ColumnRole role) const;
  double timeOf(const Source& source) const;
  double pressureOf(const Source& source) const;
  void noteReference();
  bool hasScan() const;
  std::uint64_t attachReference(Recording& recording);
  Row readRow() const;
  void readOther(ColumnRole role, const Source& source, Row& row) const;
  double reading(const Source& source) const;
  double inRange(const Source& source, double value, double largest) const;
  void append(const Row& row, Recording& recording);
  ReadingScale scale() const;
  void requireWithin(const ReadingScale& scale) const;
  void convert(const ReadingScale& scale, Recording& recording) const;

  TableReader table_;
  std::string path_;
  const TablePlan& plan_;
  std::vector<std::pair<ColumnRole, Source>> readings_, others_;
  matrix::MatrixSize size_;
  std::vector<double> values_;      // [scans x taxels], counts, V or S
  std::vector<std::size_t> lines_;  // of each scan
  bool own_reference_ = false;      // the reference was recorded by itself, at other times than the scans
  std::vector<std::pair<double, double>> reference_;  // time [s], gauge pressure [Pa]
};

bool Reader::has(ColumnRole role) const {
  return std::any_of(others_.begin(), others_.end(),
                     [role](const auto& entry) { return entry.first == role; });
}

const Source& Reader::sourceOf(ColumnRole role) const {
  const auto is = [role](const auto& entry) { return entry.first == role; };
  return std::find_if(others_.begin(), others_.end(), is)->second;
}

void Reader::requireReference() const {
  if (!own_reference_) return;
  if (!has(ColumnRole::kReference)) {
    throw settings::InputError(path_ + ": --columns names no reference, but gives it a time, rate or offset");
  }
  if (has(ColumnRole::kReferenceTime) && plan_.reference_rate) {
    throw settings::InputError(path_ +
                               ": --columns names reference_time, so --reference-rate must not be given");
  }
}

double Reader::inRange(const Source& source, double value, double largest) const {
  if (std::abs(value) <= largest) return value;
  std::ostringstream complaint;
  complaint << "is " << table_.text(source.column) << ", but in SI units must be " << largest << " at most";
  throw table_.error(source.column, complaint.str());
}

double Reader::reading(const Source& source) const {
  const TableUnit& unit = source.unit;
  if (!unit.inverse) return inRange(source, unit.factor * table_.number(source.column), kLargestValue);
  const double resistance = unit.factor * table_.numberOrInfinity(source.column);
  if (!(resistance > 0))
    throw table_.error(source.column,
                       "is a resistance of " + table_.text(source.column) + ", but must be more than 0");
  return inRange(source, 1 / resistance, kLargestValue);
}

double Reader::timeOf(const Source& source) const {
  return inRange(source, source.unit.factor * table_.number(source.column), kLatestTime);
}

double Reader::pressureOf(const Source& source) const {
  const double value = inRange(source, source.unit.factor * table_.number(source.column), kLargestValue);
  const double pressure = source.unit.quantity == "N" ? value / plan_.area : value;
  return pressure - plan_.ambient_pressure.value_or(0);
}

// Both series stand in one table, so the shorter one ends with empty cells.
bool Reader::hasScan() const {
  return !table_.text(sourceOf(ColumnRole::kTime).column).empty();
}

void Reader::noteReference() {
  const Source& source = sourceOf(ColumnRole::kReference);
  if (table_.text(source.column).empty()) return;
  double time = 0;
  if (plan_.reference_rate) {
    time = static_cast<double>(reference_.size()) /
           *plan_.reference_rate;  // the first row's is added at the end
  } else {
    time = timeOf(sourceOf(has(ColumnRole::kReferenceTime) ? ColumnRole::kReferenceTime : ColumnRole::kTime));
  }
  if (!reference_.empty() && time <= reference_.back().first) {
    throw table_.error(source.column, "has a time that is not later than that of the reference before it");
  }
  reference_.emplace_back(time, pressureOf(source));
}

// Interpolates the reference to the scans. Returns how many scans lie before or after it; they are removed.
std::uint64_t Reader::attachReference(Recording& recording) {
  if (!own_reference_) return 0;
  const double shift =
      plan_.reference_offset + (plan_.reference_rate && !recording.time.empty() ? recording.time.front() : 0);
  TimeSeries series;
  for (const auto& [time, pressure] : reference_) series.add(std::llround(1e9 * (time + shift)), pressure);
  series.sort();
  std::size_t kept = 0;
  const std::size_t scans = recording.scans(), taxels = size_.taxels();
  for (std::size_t i = 0; i < scans; ++i) {
    const auto pressure = series.empty() ? std::nullopt
                                         : series.between(std::llround(1e9 * recording.time[i]),
                                                          std::numeric_limits<std::int64_t>::max());
    if (!pressure) continue;
    recording.pressure.push_back(*pressure);
    recording.time[kept] = recording.time[i];
    recording.condition[kept] = recording.condition[i];
    if (!recording.temperature.empty()) recording.temperature[kept] = recording.temperature[i];
    lines_[kept] = lines_[i];
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(i * taxels), taxels,
                values_.begin() + static_cast<std::ptrdiff_t>(kept * taxels));
    ++kept;
  }
  recording.time.resize(kept);
  recording.condition.resize(kept);
  if (!recording.temperature.empty()) recording.temperature.resize(kept);
  lines_.resize(kept);
  values_.resize(kept * taxels);
  return scans - kept;
}

void Reader::readOther(ColumnRole role, const Source& source, Row& row) const {
  if (role == ColumnRole::kSurface) {
    row.surface.name = table_.text(source.column);
    return;
  }
  const bool of_reference = role == ColumnRole::kReference || role == ColumnRole::kReferenceTime;
  if (of_reference && own_reference_) return;  // see noteReference()
  if (role == ColumnRole::kTime) {
    row.time = timeOf(source);
    return;
  }
  if (role == ColumnRole::kReference) {
    row.pressure = pressureOf(source);
    return;
  }
  const double value = inRange(
      source, source.unit.factor * (table_.number(source.column) + source.unit.offset), kLargestValue);
  if (role == ColumnRole::kTemperature) row.temperature = value;
  if (role == ColumnRole::kCurvature) row.surface.curvature = {matrix::Curvature{value, 0, 0}};
  if (role == ColumnRole::kMount) {
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max() || value != std::floor(value))
      throw table_.error(source.column, "must be a whole number, 0 to 4294967295");
    row.surface.mount = static_cast<std::uint32_t>(value);
  }
}

Row Reader::readRow() const {
  Row row;
  row.surface.name = plan_.surface;
  if (plan_.curvature) row.surface.curvature = {matrix::Curvature{*plan_.curvature, 0, 0}};
  for (const auto& [role, source] : others_) readOther(role, source, row);
  for (const auto& [role, source] : readings_) row.readings.push_back(reading(source));
  return row;
}

void Reader::append(const Row& row, Recording& recording) {
  if (!recording.time.empty() && row.time <= recording.time.back()) {
    const auto is_time = [](const auto& entry) { return entry.first == ColumnRole::kTime; };
    const std::size_t column = std::find_if(others_.begin(), others_.end(), is_time)->second.column;
    throw table_.error(column, "is " + table_.text(column) + ", but the time must move on from row to row");
  }
  const auto same = [&](const matrix::Surface& surface) {
    return matrix::sameCondition(surface, row.surface);
  };
  auto found = std::find_if(recording.conditions.begin(), recording.conditions.end(), same);
  if (found == recording.conditions.end()) found = recording.conditions.insert(found, row.surface);
  recording.condition.push_back(static_cast<std::uint32_t>(found - recording.conditions.begin()));
  recording.time.push_back(row.time);
  if (row.pressure) recording.pressure.push_back(*row.pressure);
  if (row.temperature) recording.temperature.push_back(*row.temperature);
  values_.insert(values_.end(), row.readings.begin(), row.readings.end());
  lines_.push_back(table_.line());
}

ReadingScale Reader::scale() const {
  const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
  ReadingScale scale{0, 65535, quantity(), 65535};
  if (quantity() == "counts") {
    scale.full_scale = plan_.full_scale.value_or(*most <= 4095 ? 4095 : 65535);
    scale.high = scale.full_scale;
    if (!plan_.range) return scale;
    std::tie(scale.low, scale.high) = *plan_.range;
    if (!plan_.full_scale) {
      scale.full_scale =
          static_cast<std::uint16_t>(std::clamp(std::round(std::abs(scale.high - scale.low)), 1.0, 65535.0));
    }
    return scale;
  }
  scale.high = *most > 0 ? roundNumberAbove(*most) : 1;
  if (*least < 0) scale.low = -roundNumberAbove(-*least);
  if (plan_.range) std::tie(scale.low, scale.high) = *plan_.range;
  return scale;
}

// Names the reading that is furthest outside, and both ends of all, so that the user widens the range once.
void Reader::requireWithin(const ReadingScale& scale) const {
  const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
  const auto [low, high] = std::minmax(scale.low, scale.high);
  if (*least >= low && *most <= high) return;
  const auto furthest = low - *least > *most - high ? least : most;
  std::ostringstream complaint;
  complaint << path_ << ", line "
            << lines_[static_cast<std::size_t>(furthest - values_.begin()) / size_.taxels()]
            << ": a reading of " << *furthest << " " << scale.unit << " is outside " << scale.low << " to "
            << scale.high << " " << scale.unit << "; all readings are from " << *least << " to " << *most
            << "; widen " << (scale.unit == "counts" && !plan_.range ? "--full-scale" : "--range");
  throw settings::InputError(complaint.str());
}

void Reader::convert(const ReadingScale& scale, Recording& recording) const {
  requireWithin(scale);
  for (const double value : values_) {
    const double share = (value - scale.low) / (scale.high - scale.low);
    recording.counts.push_back(static_cast<std::uint16_t>(std::lround(share * scale.full_scale)));
  }
}

// Reads the next row; false at the end.
bool Reader::nextRow(TableRecording& result) {
  const std::size_t before = table_.line();
  try {
    if (!table_.next()) return false;
    if (own_reference_) noteReference();
    if (own_reference_ && !hasScan()) return true;
    append(readRow(), result.recording);
  } catch (const settings::InputError&) {
    const bool moved_on = table_.line() > before;  // otherwise the file itself cannot be read
    if (!plan_.skip_bad_rows || !moved_on) throw;
    ++result.skipped;
  }
  return true;
}

TableRecording Reader::read() {
  TableRecording result;
  Recording& recording = result.recording;
  recording.name = path_.substr(path_.find_last_of('/') + 1);
  recording.layout = {size_, plan_.pitch, plan_.pitch};
  while (nextRow(result)) {
  }
  result.no_reference = attachReference(recording);
  if (recording.scans() < 2) throw settings::InputError(path_ + ": holds fewer than two usable rows");
  result.scale = scale();
  if (has(ColumnRole::kReference) && sourceOf(ColumnRole::kReference).unit.quantity == "N")
    result.area = plan_.area;
  convert(result.scale, recording);
  recording.full_scale = result.scale.full_scale;
  recording.sensor.model = result.scale.text();
  result.unix_time = !plan_.start_ns && recording.time.front() >= kYear2000;
  const std::int64_t start = plan_.start_ns.value_or(result.unix_time ? 0 : std::llround(1e9 * kYear2000));
  recording.start_ns = start + std::llround(recording.time.front() * 1e9);
  const double first = recording.time.front();
  for (double& time : recording.time) time -= first;
  return result;
}

}  // namespace

std::string ReadingScale::text() const {
  std::ostringstream text;
  if (unit == "counts" && (low != 0 || high != full_scale)) {
    text << "0 counts = " << low << " and " << full_scale << " counts = " << high << " of the table";
  } else if (unit == "counts") {
    text << "counts as recorded, full scale " << full_scale;
  } else if (low == 0) {
    text << full_scale << " counts = " << high << " " << unit;
  } else {
    text << "0 counts = " << low << " " << unit << ", " << full_scale << " counts = " << high << " " << unit;
  }
  return text.str();
}

TableRecording readTable(const std::string& path, const TablePlan& plan) {
  return Reader(path, plan).read();
}

}  // namespace fsr::dataset
