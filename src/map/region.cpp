#include "fsr_pressure_map/map/region.h"

#include <cmath>
#include <set>
#include <sstream>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/settings/pressure_unit.h"
#include "settings/settings.h"

namespace fsr::map {

namespace {

constexpr double kMaxPressure = 10e6;  // [Pa]
constexpr double kMaxDwell = 3600;     // [s]

// Of the alarms in a file.
struct Unit {
  double size;  // [Pa]
  std::string name;
};

AlarmOptions readAlarm(const settings::Settings& owner, const Unit& unit) {
  AlarmOptions alarm;
  if (!owner.has("alarm")) return alarm;
  const settings::Settings settings = owner.section("alarm");
  alarm.threshold =
      unit.size * settings.number("threshold", {1 / unit.size, kMaxPressure / unit.size, unit.name});
  alarm.dwell = settings.number("dwell", {0, kMaxDwell, "s"}, alarm.dwell);
  alarm.hysteresis = unit.size * settings.number("hysteresis", {0, alarm.threshold / unit.size, unit.name},
                                                 alarm.hysteresis / unit.size);
  return alarm;
}

// First and last index of `key`; the whole range where the key is missing.
std::pair<int, int> readSpan(const settings::Settings& settings, const std::string& key, int count) {
  if (!settings.has(key)) return {0, count - 1};
  const std::vector<double> span = settings.numbers(key, {0, double(count - 1)});
  const bool whole = span.size() == 2 && std::floor(span[0]) == span[0] && std::floor(span[1]) == span[1];
  if (!whole || span[0] > span[1]) {
    throw settings.error(key, "must be two whole numbers, the first and the last");
  }
  return {static_cast<int>(span[0]), static_cast<int>(span[1])};
}

std::vector<std::uint8_t> rectangle(const settings::Settings& settings, matrix::MatrixSize size) {
  if (!settings.has("rows") && !settings.has("columns")) {
    throw settings.error("name", "has neither rows and columns nor a mask");
  }
  const auto [top, bottom] = readSpan(settings, "rows", size.rows);
  const auto [left, right] = readSpan(settings, "columns", size.columns);
  std::vector<std::uint8_t> mask(size.taxels(), 0);
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) mask[std::size_t(row) * size.columns + column] = 1;
  }
  return mask;
}

std::vector<std::uint8_t> picture(const settings::Settings& settings, matrix::MatrixSize size) {
  std::istringstream lines(settings.text("mask"));
  std::vector<std::uint8_t> mask;
  bool fits = true;
  for (std::string line; lines >> line;) {
    fits = fits && line.size() == size.columns;
    for (const char c : line) {
      if (c != '0' && c != '1' && c != '.') throw settings.error("mask", "may hold 0, 1 and . only");
      mask.push_back(c == '1');
    }
  }
  if (fits && mask.size() == size.taxels()) return mask;
  throw settings.error("mask", "must have one line for each row and one character for each column of the " +
                                   matrix::sizeText(size) + " matrix");
}

Region readRegion(const settings::Settings& settings, matrix::MatrixSize size, const Unit& unit) {
  Region region;
  region.name = settings.text("name");
  if (region.name.empty()) throw settings.error("name", "must not be empty: that is the whole matrix");
  region.mask = settings.has("mask") ? picture(settings, size) : rectangle(settings, size);
  region.alarm = readAlarm(settings, unit);
  return region;
}

std::vector<Region> readAll(const settings::Settings& settings, matrix::MatrixSize size) {
  std::vector<Region> regions(1);
  const std::string name = settings.choice("unit", {"Pa", "kPa", "mmHg"}, "Pa");
  const Unit unit{name == "Pa" ? 1 : settings::pascals(settings::pressureUnitOf(name)), name};
  regions.front().alarm = readAlarm(settings, unit);
  std::set<std::string> names;
  if (settings.has("regions")) {
    for (const settings::Settings& entry : settings.sections("regions")) {
      regions.push_back(readRegion(entry, size, unit));
      if (!names.insert(regions.back().name).second) throw entry.error("name", "is used twice");
    }
  }
  settings.refuseUnknown();
  return regions;
}

}  // namespace

std::vector<Region> readRegionFile(const std::string& path, matrix::MatrixSize size) {
  return readAll(settings::Settings::fromFile(path), size);
}

std::vector<Region> readRegions(const std::string& yaml, const std::string& origin, matrix::MatrixSize size) {
  return readAll(settings::Settings::fromText(yaml, origin), size);
}

std::vector<std::string> regionNames(const std::string& path) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  std::vector<std::string> names(1);
  if (!settings.has("regions")) return names;
  for (const settings::Settings& entry : settings.sections("regions")) names.push_back(entry.text("name"));
  return names;
}

namespace {

using namespace taxel_flag;

constexpr std::uint16_t kFailed = kDead | kStuck | kLineFault;
constexpr std::uint16_t kUnsure =
    kReadingExtrapolated | kCurvatureExtrapolated | kTemperatureExtrapolated | kFilled;

enum class Trust { kNobodysQuestion, kSure, kAtLeast, kLessThan, kNone };

Trust trustIn(float pressure, std::uint16_t flags) {
  if ((flags & kMasked) != 0) return Trust::kNobodysQuestion;
  if (std::isnan(pressure) || (flags & kFailed) != 0) return Trust::kNone;
  if (isLowerLimit(flags)) return Trust::kAtLeast;
  const bool bent_as_trained = (flags & kCurvatureExtrapolated) == 0;
  if ((flags & kBelowRange) != 0 && bent_as_trained) return Trust::kLessThan;
  return (flags & kUnsure) != 0 ? Trust::kNone : Trust::kSure;
}

}  // namespace

AlarmEvidence evidence(const PressureMap& map, const Region& region) {
  AlarmEvidence result;
  if (map.state != MapState::kOk) return result;
  result.whole = true;
  bool any = false;
  for (std::size_t i = 0; i < map.pressure.size(); ++i) {
    const Trust trust = region.has(i) ? trustIn(map.pressure[i], map.flags[i]) : Trust::kNobodysQuestion;
    if (trust == Trust::kNobodysQuestion) continue;
    any = true;
    if (trust == Trust::kNone || trust == Trust::kAtLeast) result.whole = false;
    if (trust == Trust::kNone) continue;
    double& highest = trust == Trust::kLessThan ? result.less_than : result.sure;
    highest = std::fmax(highest, double(map.pressure[i]));
  }
  result.whole = result.whole && any;
  return result;
}

AlarmState Alarm::update(double time, const AlarmEvidence& evidence) {
  if (!options_.used()) return AlarmState::kNotSet;
  if (evidence.sure >= options_.threshold) {
    if (!above_ || time < above_since_) above_since_ = time;
    above_ = true;
    raised_ = raised_ || time - above_since_ >= options_.dwell;
  } else {
    above_ = false;
    const double highest = std::fmax(evidence.sure, evidence.less_than);
    if (evidence.whole && highest < options_.threshold - options_.hysteresis) raised_ = false;
  }
  if (raised_ && (above_ || evidence.whole)) return AlarmState::kAlarm;
  return withoutAlarm(evidence);
}

AlarmState Alarm::withoutAlarm(const AlarmEvidence& evidence) const {
  const bool may_be_above = evidence.less_than >= options_.threshold;
  return evidence.whole && !may_be_above ? AlarmState::kOk : AlarmState::kUnknown;
}

AlarmState Alarm::stale() {
  above_ = false;
  return options_.used() ? AlarmState::kUnknown : AlarmState::kNotSet;
}

}  // namespace fsr::map
