#include "fsr_pressure_map/map/map_statistics.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::map {

namespace {

void requireOneSize(const PressureMap& map, const Region& region, const std::vector<double>& areas) {
  const std::size_t n = map.layout.size.taxels();
  const bool fits = map.pressure.size() == n && map.flags.size() == n && areas.size() == n &&
                    (region.mask.empty() || region.mask.size() == n);
  if (fits) return;
  throw settings::InputError("statistics of region \"" + region.name + "\": its mask has " +
                             std::to_string(region.mask.size()) + " values and there are " +
                             std::to_string(areas.size()) + " areas, but the map is " +
                             matrix::sizeText(map.layout.size));
}

/// Area-weighted sums over the contact area.
struct ContactSums {
  double area = 0;      // [m^2]
  double force = 0;     // [N]
  double squared = 0;   // [Pa^2 m^2]
  double x = 0, y = 0;  // [N m]

  void add(double pressure, double taxel_area, const matrix::Position& position) {
    area += taxel_area;
    force += pressure * taxel_area;
    squared += pressure * pressure * taxel_area;
    x += pressure * taxel_area * position.x;
    y += pressure * taxel_area * position.y;
  }
};

void finish(const ContactSums& sums, bool any_reading, RegionStatistics& result) {
  result.contact_area = sums.area;
  if (any_reading) result.force = sums.force;
  if (!(sums.area > 0)) return;
  result.mean = sums.force / sums.area;
  result.standard_deviation = std::sqrt(std::max(0.0, sums.squared / sums.area - result.mean * result.mean));
  if (sums.force > 0) result.centre = matrix::Position{sums.x / sums.force, sums.y / sums.force};
}

AlarmState worse(AlarmState a, AlarmState b) {
  const auto rank = [](AlarmState s) {
    if (s == AlarmState::kAlarm) return 3;
    return s == AlarmState::kUnknown ? 2 : s == AlarmState::kNotSet ? 1 : 0;
  };
  return rank(a) >= rank(b) ? a : b;
}

}  // namespace

RegionStatistics regionStatistics(const PressureMap& map, const Region& region,
                                  const std::vector<double>& areas, double contact_threshold) {
  requireOneSize(map, region, areas);
  RegionStatistics result;
  result.region = region.name;
  ContactSums sums;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (!region.has(i) || (map.flags[i] & taxel_flag::kMasked) != 0) continue;
    result.total_area += areas[i];
    const double pressure = double(map.pressure[i]);
    if (std::isnan(pressure)) {
      ++result.bad;
      continue;
    }
    if (isLowerLimit(map.flags[i])) ++result.at_least;
    if (!(pressure <= result.peak)) {  // true for the first reading, when peak is NaN
      result.peak = pressure;
      result.peak_taxel = {i};
    }
    if (inContact(pressure, map.flags[i], contact_threshold))
      sums.add(pressure, areas[i], map.layout.position({i}));
  }
  finish(sums, !std::isnan(result.peak), result);
  return result;
}

void PressureIntegral::reset() {
  started_ = false;
  duration_ = 0;
  integral_.clear();
}

void PressureIntegral::add(double time, const PressureMap& map) {
  if (integral_.size() != map.pressure.size() || (started_ && time < last_time_)) {
    reset();
    integral_.assign(map.pressure.size(), 0);
  }
  const double step = time - last_time_;
  if (started_ && step <= longest_gap_) {
    duration_ += step;
    for (std::size_t i = 0; i < integral_.size(); ++i) {
      const double sum = double(map.pressure[i]) + double(last_[i]);
      if (!std::isnan(sum)) integral_[i] += 0.5 * step * sum;
    }
  }
  last_ = map.pressure;
  last_time_ = time;
  started_ = true;
}

double PressureIntegral::largest(const Region& region) const {
  double result = 0;
  for (std::size_t i = 0; i < integral_.size(); ++i) {
    if (region.has(i)) result = std::max(result, integral_[i]);
  }
  return result;
}

RegionStatistics sumOfSheets(const std::string& region, const std::vector<RegionStatistics>& sheets) {
  RegionStatistics sum;
  sum.region = region;
  sum.alarm = sheets.empty() ? AlarmState::kUnknown : AlarmState::kOk;
  double squared = 0;  // [Pa^2 m^2]
  for (const RegionStatistics& sheet : sheets) {
    if (!(sheet.peak <= sum.peak) && !std::isnan(sheet.peak)) {
      sum.peak = sheet.peak;
      sum.peak_taxel = sheet.peak_taxel;
    }
    sum.contact_area += sheet.contact_area;
    sum.total_area += sheet.total_area;
    sum.bad += sheet.bad;
    sum.at_least += sheet.at_least;
    sum.pressure_time_integral = std::max(sum.pressure_time_integral, sheet.pressure_time_integral);
    sum.duration = std::max(sum.duration, sheet.duration);
    sum.alarm = worse(sum.alarm, sheet.alarm);
    if (!std::isnan(sheet.force)) sum.force = std::isnan(sum.force) ? sheet.force : sum.force + sheet.force;
    if (sheet.contact_area > 0) {
      squared += sheet.contact_area *
                 (sheet.mean * sheet.mean + sheet.standard_deviation * sheet.standard_deviation);
    }
  }
  if (sum.contact_area > 0) {
    sum.mean = sum.force / sum.contact_area;
    sum.standard_deviation = std::sqrt(std::max(0.0, squared / sum.contact_area - sum.mean * sum.mean));
  }
  return sum;
}

MapStatistics::MapStatistics(std::vector<Region> regions, double contact_threshold)
    : regions_(std::move(regions)), contact_threshold_(contact_threshold) {
  for (const Region& region : regions_) alarms_.emplace_back(region.alarm);
}

bool MapStatistics::setAlarm(const std::string& region, const AlarmOptions& options) {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    if (regions_[i].name != region) continue;
    regions_[i].alarm = options;
    alarms_[i] = Alarm(options);
    return true;
  }
  return false;
}

const std::vector<RegionStatistics>& MapStatistics::update(double time, const PressureMap& map,
                                                           const std::vector<double>& areas) {
  integral_.add(time, map);
  statistics_.clear();
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    RegionStatistics one = regionStatistics(map, regions_[i], areas, contact_threshold_);
    one.pressure_time_integral = integral_.largest(regions_[i]);
    one.duration = integral_.duration();
    one.alarm = alarms_[i].update(time, evidence(map, regions_[i]));
    statistics_.push_back(std::move(one));
  }
  return statistics_;
}

std::vector<RegionStatistics> MapStatistics::stale() {
  std::vector<RegionStatistics> result(regions_.size());
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    result[i].region = regions_[i].name;
    result[i].alarm = alarms_[i].stale();
  }
  return result;
}

}  // namespace fsr::map
