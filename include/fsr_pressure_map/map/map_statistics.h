#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/alarm.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/map/region.h"

namespace fsr::map {

/// Summary of one region of a map; NaN where the map gives no answer. Pressures are gauge.
struct RegionStatistics {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string region;                 ///< "" = the whole matrix
  double peak = kNone;                ///< highest reading [Pa]
  matrix::TaxelIndex peak_taxel;      ///< where it is; meaningless while peak is NaN
  double mean = kNone;                ///< over the contact area, weighted by area [Pa]
  double standard_deviation = kNone;  ///< over the contact area, likewise [Pa]
  double contact_area = 0;            ///< of the taxels in contact [m^2]
  double total_area = 0;              ///< of the region's taxels, masked ones left out [m^2]
  double force = kNone;               ///< sum of normal force over the contact area [N]
  double pressure_time_integral = 0;  ///< of the taxel that gathered most [Pa s]
  double duration = 0;                ///< that the integral spans [s]
  std::size_t bad = 0;                ///< taxels without a reading, masked ones left out
  std::size_t saturated = 0;
  std::optional<matrix::Position> centre;  ///< of pressure, on the flat sheet [m]; none without contact
  AlarmState alarm = AlarmState::kUnknown;
};

/// A taxel is in contact from `contact_threshold` [Pa] on, unless it is under its turn-on pressure. `areas`
/// are those of the taxels on the bent sheet (view: taxelAreas) [rows x columns], row-major [m^2]. The force
/// is the sum of pressure x area, each taxel's along its own normal, so not the length of their vector
/// sum. Throws InputError where map, region and areas are not of one size.
RegionStatistics regionStatistics(const PressureMap& map, const Region& region,
                                  const std::vector<double>& areas, double contact_threshold);

/// Pressure-time integral of each taxel, by trapezoids between maps. Gaps longer than `longest_gap`, maps
/// that give no pressure, and time that runs back (a looped bag: starts anew) are not bridged.
class PressureIntegral {
 public:
  explicit PressureIntegral(double longest_gap = 1.0) : longest_gap_(longest_gap) {}

  void add(double time, const PressureMap& map);
  void reset();

  double duration() const { return duration_; }
  /// Largest integral of a taxel in the region [Pa s].
  double largest(const Region& region) const;

 private:
  double longest_gap_;   // [s]
  double duration_ = 0;  // [s]
  double last_time_ = 0;
  bool started_ = false;
  std::vector<float> last_;       // [Pa]
  std::vector<double> integral_;  // [Pa s]
};

/// Several sheets round one limb as one: areas, forces and counts add up, the peak and the integral are the
/// highest, mean and deviation are over all their contact area; no centre, for they share no sheet. The
/// alarm is the worst: alarm, then unknown, then OK. The peak's taxel is that of its own sheet.
RegionStatistics sumOfSheets(const std::string& region, const std::vector<RegionStatistics>& sheets);

/// Statistics of all regions over time.
class MapStatistics {
 public:
  MapStatistics(std::vector<Region> regions, double contact_threshold);

  /// `time` of the map [s]; `areas` as for regionStatistics(). Throws InputError likewise.
  const std::vector<RegionStatistics>& update(double time, const PressureMap& map,
                                              const std::vector<double>& areas);
  /// What is to be said when no map has come for too long: names and UNKNOWN.
  std::vector<RegionStatistics> stale();
  void resetIntegral() { integral_.reset(); }

 private:
  std::vector<Region> regions_;
  std::vector<Alarm> alarms_;
  double contact_threshold_;  // [Pa]
  PressureIntegral integral_;
  std::vector<RegionStatistics> statistics_;
};

}  // namespace fsr::map
