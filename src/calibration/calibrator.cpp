#include "fsr_pressure_map/calibration/calibrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "calibration/packed_tables.h"
#include "calibration/stages/memory/history_state.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "map/fill.h"

namespace fsr::calibration {

namespace {

constexpr double kOnClass = 1e-6;  // [1/m]
constexpr float kNoReading = std::numeric_limits<float>::quiet_NaN();
// A reading that says nothing of the load, or only a limit of it.
constexpr std::uint16_t kFrozen = map::taxel_flag::kSaturated | map::taxel_flag::kDead |
                                  map::taxel_flag::kStuck | map::taxel_flag::kLineFault |
                                  map::taxel_flag::kMasked;
constexpr std::uint16_t kBelowTraining = map::taxel_flag::kReadingExtrapolated | map::taxel_flag::kBelowRange;

// The flag if the condition is true, else 0.
inline std::uint16_t flagWhere(bool condition, std::uint16_t flag) {
  return static_cast<std::uint16_t>(-static_cast<int>(condition) & flag);
}

inline void copyOne(const compensation::TableEntry& entry, float& pressure, float& deviation) {
  pressure = entry.pressure;
  deviation = entry.deviation;
}

// The entry of a code between two stored entries, by linear interpolation.
inline compensation::TableEntry between(const compensation::TableEntry* table, std::uint16_t code,
                                        unsigned shift) {
  const compensation::TableEntry* const entry = table + (code >> shift);
  const unsigned step = 1u << shift;
  const float share = static_cast<float>(code & (step - 1)) / static_cast<float>(step);
  return {entry[0].pressure + share * (entry[1].pressure - entry[0].pressure),
          entry[0].deviation + share * (entry[1].deviation - entry[0].deviation)};
}

bool allFinite(const compensation::TableEntry* table, std::size_t entries) {
  return std::all_of(table, table + entries,
                     [](const compensation::TableEntry& entry) { return std::isfinite(entry.pressure); });
}

void requireEach(const char* what, std::size_t values, matrix::MatrixSize size) {
  if (values != 0 && values != size.taxels()) {
    throw settings::InputError(std::string(what) + " has " + std::to_string(values) +
                               " values, but must have none, or one for each of the " +
                               std::to_string(size.taxels()) + " taxels of the " + std::to_string(size.rows) +
                               " x " + std::to_string(size.columns) + " matrix");
  }
}

}  // namespace

class Calibrator::Impl {
 public:
  Impl(const compensation::CurvatureTables& tables, const matrix::Layout& layout, const HistoryModel& history,
       const TemperatureModel& temperature, const DeviationScale& scale, const CalibratorOptions& options);
  Impl(const Impl&) = delete;  // table_ points into the object's own tables
  Impl& operator=(const Impl&) = delete;

  void setSurface(const matrix::Surface& surface, double time);
  void setMask(const std::vector<std::uint8_t>& mask);
  void setTare(const std::vector<float>& offset);
  void showTables(map::PressureMap& map) const;
  void markRest() {
    if (history_ != nullptr) history_->rest();
  }
  void setTemperature(double temperature, double trained_low, double trained_high);
  void setWrongSensor(bool wrong) { wrong_sensor_ = wrong; }
  void calibrate(const matrix::ScanView& scan, double time, map::PressureMap& out) noexcept;

  const matrix::Layout& layout() const { return layout_; }
  std::size_t bytes() const { return tables_.bytes() + blended_.size() * sizeof(compensation::TableEntry); }
  const health::TaxelWatch& watch() const { return watch_; }
  const std::vector<ClassChoice>& choices() const { return switch_.choices(); }

 private:
  struct CurvatureInUse {
    double value;
    double deviation;  // 0 = unknown
  };
  // Table, and where it is a blended one: its curvature and class.
  using TableInUse = std::tuple<const compensation::TableEntry*, double, std::size_t>;

  void selectTables(const matrix::Surface& surface);
  void selectTable(std::size_t taxel, CurvatureInUse now);
  std::size_t stride() const { return tables_.entries() + PackedTables::kPadding; }
  bool isBlended(std::size_t taxel) const noexcept;
  TableInUse inUse(std::size_t taxel) const;
  std::uint16_t highestOfNeighbours(std::size_t taxel, double curvature) const;
  const compensation::TableEntry* blended(std::size_t taxel, CurvatureInUse now);
  float beyondClass(std::size_t taxel, float deviation) const noexcept;
  void refreshConstantFlags() noexcept;
  void noteTime(double time) noexcept;
  void clip(const std::uint16_t* counts) noexcept;
  void lookUp(map::PressureMap& out) const noexcept;
  void flagCodes(map::PressureMap& out) const noexcept;
  void correctHistory(double time, map::PressureMap& out) noexcept;
  void removeBad(map::PressureMap& out) const noexcept;
  map::MapState state(double time) const noexcept;

  PackedTables tables_;
  matrix::Layout layout_;
  CalibratorOptions options_;
  bool needs_curvature_;
  compensation::CurvatureRule rule_;
  ClassSwitch switch_;
  health::TaxelWatch watch_;

  bool surface_known_ = false;
  double surface_time_ = 0;  // [s]
  double last_time_ = 0;     // [s]
  bool wrong_sensor_ = false;
  bool temperature_beyond_ = false;  // that of training
  std::vector<std::uint8_t> mask_;   // [taxels]
  std::vector<std::uint8_t> model_;  // [taxels], 0 = the table in use is empty

  // Tables computed for the present curvature, and the curvature that they are for. Allocated with the first
  // one.
  struct Blended {
    double curvature;
    double deviation;
    std::size_t chosen;
    bool finite;
  };
  std::vector<compensation::TableEntry> blended_;  // [taxels x stride]
  std::vector<Blended> blended_for_;               // [taxels]
  bool tared_ = false;

  // What the loop over taxels reads, each [taxels], row-major.
  std::vector<std::uint16_t> codes_;  // of the scan, limited to full scale
  std::vector<const compensation::TableEntry*> table_;
  std::vector<float> offset_;          // [Pa]
  std::vector<std::uint16_t> lowest_;  // codes of training of the table in use
  std::vector<std::uint16_t> highest_;
  std::vector<std::uint16_t> constant_flags_;  // flags that do not depend on the code
  std::vector<std::size_t> masked_;            // taxels without a reading, never filled
  std::vector<std::size_t> failed_;            // dead or stuck taxels that are not masked
  std::vector<std::size_t> undetermined_;      // taxels whose deviation is unknown

  std::unique_ptr<HistoryState> history_;        // null = the tables alone answer
  std::optional<TemperatureState> temperature_;  // none = the pressure does not depend on it
};

Calibrator::Impl::Impl(const compensation::CurvatureTables& tables, const matrix::Layout& layout,
                       const HistoryModel& history, const TemperatureModel& temperature,
                       const DeviationScale& scale, const CalibratorOptions& options)
    : tables_(tables, scale),
      layout_(layout),
      options_(options),
      needs_curvature_(tables.scheme != compensation::Scheme::kBaseline),
      rule_(tables.rule),
      switch_(tables, options.class_hysteresis),
      watch_(tables.size, tables.full_scale, options.watch),
      mask_(tables.size.taxels(), 0),
      model_(tables.size.taxels(), 1),
      codes_(tables.size.taxels()),
      table_(tables.size.taxels()),
      offset_(tables.size.taxels(), 0.0f),
      lowest_(tables.size.taxels()),
      highest_(tables.size.taxels()),
      constant_flags_(tables.size.taxels()) {
  if (layout.size != tables.size)
    throw settings::InputError("calibration: its layout is not the size of its tables");
  masked_.reserve(tables.size.taxels());
  failed_.reserve(tables.size.taxels());
  undetermined_.reserve(tables.size.taxels());
  if (history.present()) {
    history_ = std::make_unique<HistoryState>(history, tables.size.taxels());
  }
  if (temperature.present()) temperature_.emplace(temperature);
  selectTables({});
}

void Calibrator::Impl::setSurface(const matrix::Surface& surface, double time) {
  matrix::requireFit(surface, layout_.size);
  surface_known_ = surface.known();
  surface_time_ = time;
  if (surface_known_) {
    switch_.choose(surface);
  } else {
    switch_.fallBack();
  }
  selectTables(surface);
}

void Calibrator::Impl::setMask(const std::vector<std::uint8_t>& mask) {
  requireEach("mask", mask.size(), layout_.size);
  std::fill(mask_.begin(), mask_.end(), std::uint8_t{0});
  std::copy(mask.begin(), mask.end(), mask_.begin());
  refreshConstantFlags();
}

void Calibrator::Impl::setTare(const std::vector<float>& offset) {
  requireEach("tare", offset.size(), layout_.size);
  tared_ = !offset.empty();
  const std::vector<float> before = offset_;
  std::fill(offset_.begin(), offset_.end(), 0.0f);
  std::copy(offset.begin(), offset.end(), offset_.begin());
  if (history_ != nullptr && offset_ != before) history_->forget();
  refreshConstantFlags();
}

void Calibrator::Impl::setTemperature(double temperature, double trained_low, double trained_high) {
  const double margin = options_.temperature_margin;
  if (temperature_) temperature_->setTemperature(temperature, margin);
  const bool beyond = temperature < trained_low - margin || temperature > trained_high + margin;
  if (beyond == temperature_beyond_) return;
  temperature_beyond_ = beyond;
  refreshConstantFlags();
}

// For an unknown surface the curvature is that of the class that the switch has chosen.
void Calibrator::Impl::selectTables(const matrix::Surface& surface) {
  for (std::size_t taxel = 0; taxel < table_.size(); ++taxel) {
    const std::size_t chosen = switch_.choices()[taxel].curvature_class;
    selectTable(taxel, surface.known() ? CurvatureInUse{matrix::principalCurvature(surface.at({taxel})),
                                                        surface.deviationAt({taxel})}
                                       : CurvatureInUse{tables_.tables(taxel).curvature[chosen], 0});
  }
  refreshConstantFlags();
}

bool Calibrator::Impl::isBlended(std::size_t taxel) const noexcept {
  return !blended_.empty() && table_[taxel] == blended_.data() + taxel * stride();
}

Calibrator::Impl::TableInUse Calibrator::Impl::inUse(std::size_t taxel) const {
  const compensation::TableEntry* const table = table_[taxel];
  if (!isBlended(taxel)) return {table, 0, 0};
  return {table, blended_for_[taxel].curvature, blended_for_[taxel].chosen};
}

void Calibrator::Impl::selectTable(std::size_t taxel, CurvatureInUse now) {
  const ClassChoice& choice = switch_.choices()[taxel];
  const std::size_t chosen = choice.curvature_class;
  const PackedTables::TrainedCodes trained = tables_.trained(taxel, chosen);
  const bool on_class = std::abs(now.value - tables_.tables(taxel).curvature[chosen]) <= kOnClass;
  const bool blend =
      trained.model && tables_.classes() > 1 &&
      (rule_.blend == compensation::BlendRule::kKernel || choice.flags != 0 || now.deviation > 0 ||
       (rule_.blend == compensation::BlendRule::kInterpolate && !on_class));
  const TableInUse before = inUse(taxel);
  table_[taxel] = blend ? blended(taxel, now) : tables_.table(taxel, chosen);
  // Another table gives another answer to the same reading, which is no change of load.
  if (history_ != nullptr && inUse(taxel) != before) history_->forget(taxel);
  lowest_[taxel] = trained.lowest;
  highest_[taxel] = blend ? highestOfNeighbours(taxel, now.value) : trained.highest;
  model_[taxel] = trained.model && (!blend || blended_for_[taxel].finite);
}

// Above the highest code of one of the classes that are blended, that class knows no higher pressure, and the
// blend is too low.
std::uint16_t Calibrator::Impl::highestOfNeighbours(std::size_t taxel, double curvature) const {
  const compensation::CurvaturePlace place =
      compensation::placeOf(curvature, tables_.tables(taxel).curvature);
  return std::min(tables_.trained(taxel, place.below).highest, tables_.trained(taxel, place.above).highest);
}

const compensation::TableEntry* Calibrator::Impl::blended(std::size_t taxel, CurvatureInUse asked) {
  if (blended_.empty()) {
    blended_.resize(table_.size() * stride());
    blended_for_.assign(table_.size(), {std::numeric_limits<double>::quiet_NaN(), 0, 0, false});
  }
  const std::size_t chosen = switch_.choices()[taxel].curvature_class;
  compensation::TableEntry* const table = blended_.data() + taxel * stride();
  Blended& now = blended_for_[taxel];
  if (now.chosen == chosen && now.deviation == asked.deviation &&
      std::abs(now.curvature - asked.value) <= options_.curvature_step)
    return table;
  compensation::blendTable(rule_,
                           rule_.blend == compensation::BlendRule::kKernel ? rule_.lengthScale(taxel) : 0,
                           tables_.tables(taxel), asked.value, chosen, table);
  if (asked.deviation > 0)
    compensation::addCurvatureDeviation(tables_.tables(taxel), asked.value, asked.deviation, table);
  // A faulty rule, or a class without a model, may give a value that is not a pressure. Then the taxel has no
  // model.
  now = {asked.value, asked.deviation, chosen, allFinite(table, tables_.entries())};
  return table;
}

void Calibrator::Impl::refreshConstantFlags() noexcept {
  masked_.clear();
  failed_.clear();
  undetermined_.clear();
  const std::uint16_t warm = flagWhere(temperature_beyond_, map::taxel_flag::kTemperatureExtrapolated);
  for (std::size_t taxel = 0; taxel < constant_flags_.size(); ++taxel) {
    const bool masked = mask_[taxel] != 0 || model_[taxel] == 0;
    const std::uint16_t health = watch_.flags()[taxel];
    if (masked) masked_.push_back(taxel);
    if (!masked && health != 0) failed_.push_back(taxel);
    // From one surface nothing can be known of the error on another one.
    const bool elsewhere = (switch_.choices()[taxel].flags & map::taxel_flag::kCurvatureExtrapolated) != 0;
    if (elsewhere && tables_.classes() == 1) undetermined_.push_back(taxel);
    constant_flags_[taxel] = static_cast<std::uint16_t>(switch_.choices()[taxel].flags | health |
                                                        (masked ? map::taxel_flag::kMasked : 0) |
                                                        (tared_ ? map::taxel_flag::kTared : 0) | warm);
  }
}

void Calibrator::Impl::calibrate(const matrix::ScanView& scan, double time, map::PressureMap& out) noexcept {
  const std::size_t taxels = layout_.size.taxels();
  if (scan.size != layout_.size || scan.full_scale != tables_.fullScale() || scan.count != taxels) {
    out.reset({matrix::honestSize(scan), layout_.pitch_x, layout_.pitch_y});
    out.state = map::MapState::kSizeMismatch;
    return;
  }
  if (out.pressure.size() != taxels || out.deviation.size() != taxels || out.flags.size() != taxels) {
    out.reset(layout_);
  }
  out.layout = layout_;
  noteTime(time);
  if (watch_.observe(scan.counts, time)) refreshConstantFlags();
  clip(scan.counts);
  lookUp(out);
  flagCodes(out);
  if (history_ != nullptr) correctHistory(time, out);
  if (temperature_) {
    temperature_->beginScan(time);
    temperature_->correct(taxels, out.pressure.data(), out.deviation.data());
  }
  removeBad(out);
  out.state = state(time);
}

void Calibrator::Impl::showTables(map::PressureMap& map) const {
  if (map.layout.size != layout_.size) return;
  map::PressureMap answers = map;
  lookUp(answers);
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    if (!std::isnan(map.pressure[i])) map.pressure[i] = answers.pressure[i];
  }
}

// After a jump back in time the last surface would be in the future; it counts as new from here on.
void Calibrator::Impl::noteTime(double time) noexcept {
  if (time < last_time_) surface_time_ = std::min(surface_time_, time);
  last_time_ = time;
}

void Calibrator::Impl::clip(const std::uint16_t* counts) noexcept {
  const std::uint16_t full_scale = tables_.fullScale();
  const std::size_t n = codes_.size();
  for (std::size_t i = 0; i < n; ++i) codes_[i] = std::min(counts[i], full_scale);
}

void Calibrator::Impl::lookUp(map::PressureMap& out) const noexcept {
  const std::uint16_t* codes = codes_.data();
  const compensation::TableEntry* const* table = table_.data();
  float* pressure = out.pressure.data();
  float* deviation = out.deviation.data();
  const std::size_t n = codes_.size();
  if (tables_.shift() == 0) {
    for (std::size_t i = 0; i < n; ++i) copyOne(table[i][codes[i]], pressure[i], deviation[i]);
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      copyOne(between(table[i], codes[i], tables_.shift()), pressure[i], deviation[i]);
    }
  }
  if (!tared_) return;
  for (std::size_t i = 0; i < n; ++i) pressure[i] -= offset_[i];
}

// Without branches and in 16 bits, so that the compiler vectorises it for eight taxels at a time.
void Calibrator::Impl::flagCodes(map::PressureMap& out) const noexcept {
  const std::uint16_t full_scale = tables_.fullScale();
  const std::uint16_t* codes = codes_.data();
  const std::uint16_t* lowest = lowest_.data();
  const std::uint16_t* highest = highest_.data();
  const std::uint16_t* constant = constant_flags_.data();
  std::uint16_t* flags = out.flags.data();
  const std::size_t n = layout_.size.taxels();
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t code = codes[i];
    flags[i] =
        static_cast<std::uint16_t>(constant[i] | flagWhere(code == full_scale, map::taxel_flag::kSaturated) |
                                   flagWhere(code < lowest[i], kBelowTraining) |
                                   flagWhere(code > highest[i], map::taxel_flag::kReadingExtrapolated) |
                                   flagWhere(code == 0, map::taxel_flag::kBelowRange));
  }
}

void Calibrator::Impl::correctHistory(double time, map::PressureMap& out) noexcept {
  history_->beginScan(time);
  const std::size_t n = layout_.size.taxels();
  for (std::size_t i = 0; i < n; ++i) {
    const auto frozen = static_cast<std::uint16_t>(out.flags[i] & kFrozen);
    if (frozen == map::taxel_flag::kSaturated) history_->atLeast(i, double(out.pressure[i]));
    const float before = out.deviation[i];
    const HistoryAnswer answer = history_->correct(i, frozen != 0, out.pressure[i], out.deviation[i]);
    if (answer != HistoryAnswer::kNoReading && isBlended(i))
      out.deviation[i] = std::hypot(out.deviation[i], beyondClass(i, before));
    out.flags[i] = static_cast<std::uint16_t>(
        out.flags[i] | flagWhere(answer != HistoryAnswer::kSettled, map::taxel_flag::kHistoryShort));
  }
}

// The part of a blended table's deviation that its class does not have: from the curvature [Pa]. A model of
// the sheet's memory, which was scored on the classes, does not have it either.
float Calibrator::Impl::beyondClass(std::size_t taxel, float deviation) const noexcept {
  const std::size_t chosen = switch_.choices()[taxel].curvature_class;
  const float own = tables_.table(taxel, chosen)[codes_[taxel] >> tables_.shift()].deviation;
  return std::sqrt(std::max(deviation * deviation - own * own, 0.0F));
}

void Calibrator::Impl::removeBad(map::PressureMap& out) const noexcept {
  for (const std::size_t taxel : undetermined_) out.deviation[taxel] = kNoReading;
  if (masked_.empty() && failed_.empty()) return;
  for (const auto* taxels : {&masked_, &failed_}) {
    for (const std::size_t taxel : *taxels) {
      out.pressure[taxel] = kNoReading;
      out.deviation[taxel] = kNoReading;
    }
  }
  if (options_.fill_bad_taxels) map::fillFromNeighbours(out, failed_);
}

map::MapState Calibrator::Impl::state(double time) const noexcept {
  if (wrong_sensor_) return map::MapState::kWrongSensor;
  if (!needs_curvature_) return map::MapState::kOk;
  if (!surface_known_) return map::MapState::kCurvatureUnknown;
  const double timeout = options_.curvature_timeout;
  return timeout > 0 && time - surface_time_ > timeout ? map::MapState::kCurvatureStale : map::MapState::kOk;
}

Calibrator::Calibrator(const compensation::CurvatureTables& tables, const matrix::Layout& layout,
                       const CalibratorOptions& options)
    : impl_(std::make_unique<Impl>(tables, layout, HistoryModel{}, TemperatureModel{}, DeviationScale{},
                                   options)) {}

Calibrator::Calibrator(const Calibration& calibration, const CalibratorOptions& options)
    : impl_(std::make_unique<Impl>(calibration.tables, calibration.layout, calibration.history,
                                   calibration.temperature, calibration.budget.intervals.scale, options)) {}

Calibrator::~Calibrator() = default;
Calibrator::Calibrator(Calibrator&& other) noexcept = default;

void Calibrator::setSurface(const matrix::Surface& surface, double time) {
  impl_->setSurface(surface, time);
}

void Calibrator::setMask(const std::vector<std::uint8_t>& mask) {
  impl_->setMask(mask);
}

void Calibrator::setTare(const std::vector<float>& offset) {
  impl_->setTare(offset);
}

void Calibrator::markRest() {
  impl_->markRest();
}

void Calibrator::setTemperature(double temperature, double trained_low, double trained_high) {
  impl_->setTemperature(temperature, trained_low, trained_high);
}

void Calibrator::setWrongSensor(bool wrong) {
  impl_->setWrongSensor(wrong);
}

void Calibrator::calibrate(const matrix::ScanView& scan, double time, map::PressureMap& out) noexcept {
  impl_->calibrate(scan, time, out);
}

void Calibrator::showTables(map::PressureMap& map) const {
  impl_->showTables(map);
}

const matrix::Layout& Calibrator::layout() const {
  return impl_->layout();
}

std::size_t Calibrator::bytes() const {
  return impl_->bytes();
}

const health::TaxelWatch& Calibrator::watch() const {
  return impl_->watch();
}

const std::vector<ClassChoice>& Calibrator::choices() const {
  return impl_->choices();
}

}  // namespace fsr::calibration
