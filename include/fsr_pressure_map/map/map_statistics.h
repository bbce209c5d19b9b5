#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/map/region.h"

namespace fsr::map {

/// Summary of one region of a map. NaN where the map has no answer. Pressures are gauge.
struct RegionStatistics {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string region;                      ///< "" = the whole matrix
  double peak = kNone;                     ///< highest reading [Pa]
  matrix::TaxelIndex peak_taxel;           ///< taxel of the peak; undefined while peak is NaN
  double mean = kNone;                     ///< over the contact area, weighted by area [Pa]
  double standard_deviation = kNone;       ///< over the contact area, weighted by area [Pa]
  double contact_area = 0;                 ///< of the taxels in contact [m^2]
  double total_area = 0;                   ///< of the region's taxels without masked ones [m^2]
  double force = kNone;                    ///< sum of normal force over the contact area [N]
  double pressure_time_integral = 0;       ///< largest of the taxels [Pa s]
  double duration = 0;                     ///< of the integral [s]
  std::size_t bad = 0;                     ///< taxels without a reading; masked ones are not counted
  std::size_t at_least = 0;                ///< taxels whose pressure is at least their reading (isLowerLimit)
  std::optional<matrix::Position> centre;  ///< centre of pressure on the flat sheet [m]; none without contact
  AlarmState alarm = AlarmState::kUnknown;
};

/// Whether a taxel is in contact: its pressure is at least `threshold` [Pa], and not below its turn-on
/// pressure.
constexpr bool inContact(double pressure, std::uint16_t flags, double threshold) {
  return pressure >= threshold && (flags & taxel_flag::kBelowRange) == 0;
}

/// Summary of one map. A taxel is in contact at `contact_threshold` [Pa] and above, unless it is below its
/// turn-on pressure. `areas`: areas of the taxels on the bent sheet (view: taxelAreas) [rows x columns],
/// row-major [m^2]. The force is the sum of pressure x area. Each taxel's force points along its own normal,
/// so this sum is not the length of their vector sum. Throws InputError where map, region and areas have
/// different sizes.
RegionStatistics regionStatistics(const PressureMap& map, const Region& region,
                                  const std::vector<double>& areas, double contact_threshold);

/// Pressure-time integral of each taxel, by trapezoids between maps. Gaps longer than `longest_gap` [s] and
/// maps without pressure add nothing. Time that runs backwards (a looped bag) restarts the integral.
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

/// Statistics of several sheets around one limb, as one. Areas, forces and counts are added. Peak and
/// integral are the largest. Mean and deviation are over the contact area of all sheets. There is no centre,
/// because the sheets have no common plane. The alarm is the worst: alarm, unknown, not set, OK. The peak's
/// taxel is an index on its own sheet.
RegionStatistics sumOfSheets(const std::string& region, const std::vector<RegionStatistics>& sheets);

/// Statistics of all regions over time.
class MapStatistics {
 public:
  MapStatistics(std::vector<Region> regions, double contact_threshold);

  /// `time` of the map [s]; `areas` and errors as for regionStatistics().
  const std::vector<RegionStatistics>& update(double time, const PressureMap& map,
                                              const std::vector<double>& areas);
  /// The statistics where no map has come for too long: names, and alarms that are unknown.
  std::vector<RegionStatistics> stale();
  void resetIntegral() { integral_.reset(); }
  /// Replaces the alarm of a region, which starts anew. Returns false if there is no region of that name.
  bool setAlarm(const std::string& region, const AlarmOptions& options);
  const std::vector<Region>& regions() const { return regions_; }

 private:
  std::vector<Region> regions_;
  std::vector<Alarm> alarms_;
  double contact_threshold_;  // [Pa]
  PressureIntegral integral_;
  std::vector<RegionStatistics> statistics_;
};

}  // namespace fsr::map
