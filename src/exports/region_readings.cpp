#include "exports/region_readings.h"

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/bent_sheet.h"

namespace fsr::exports {

namespace {

void addDeviations(const map::PressureMap& map, const map::Region& region, const std::vector<double>& areas,
                   double contact_threshold, RegionReading& reading) {
  double area = 0, sum = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double pressure = map.pressure[i];
    if (!region.has(i) || std::isnan(pressure) || (map.flags[i] & map::taxel_flag::kMasked) != 0) continue;
    area += areas[i];
    sum += areas[i] * pressure;
    if (!map::inContact(pressure, map.flags[i], contact_threshold)) continue;
    if (std::isnan(reading.force_deviation)) reading.force_deviation = 0;
    reading.force_deviation += areas[i] * double(map.deviation[i]);
  }
  if (area > 0) reading.mean_of_all = sum / area;
  if (reading.of.contact_area > 0) reading.mean_deviation = reading.force_deviation / reading.of.contact_area;
  if (!std::isnan(reading.of.peak)) reading.peak_deviation = map.deviation[reading.of.peak_taxel.value];
}

}  // namespace

void RegionReader::begin(const ExportSubject& subject) {
  if (!subject.maps)
    throw settings::InputError(
        "holds no pressure maps; give the calibration of the sheet with --calibration FILE");
  statistics_.reset();
  areas_.clear();
}

const std::vector<RegionReading>& RegionReader::read(const ScanRecord& scan) {
  readings_.clear();
  if (!scan.map) return readings_;
  if (!statistics_) {
    std::vector<map::Region> regions(1);
    if (!options_.regions.empty()) regions = map::readRegionFile(options_.regions, scan.layout.size);
    statistics_.emplace(std::move(regions), options_.contact_threshold);
  }
  if (areas_.empty() || surface_ != scan.surface) {
    surface_ = scan.surface;
    areas_ = view::taxelAreas(scan.layout, surface_ ? *surface_ : matrix::Surface{});
  }
  for (const map::RegionStatistics& region :
       statistics_->update(1e-9 * double(scan.since_ns), *scan.map, areas_)) {
    readings_.push_back({region});
    addDeviations(*scan.map, statistics_->regions()[readings_.size() - 1], areas_, options_.contact_threshold,
                  readings_.back());
  }
  return readings_;
}

std::vector<TableColumn> withSheet(std::vector<TableColumn> columns, const StatisticsOptions& options) {
  if (options.sheets) columns.insert(columns.begin() + 1, {"sheet", "", "its namespace in the bag", true});
  return columns;
}

std::vector<TableValue> withSheet(std::vector<TableValue> row, const std::string& sheet,
                                  const StatisticsOptions& options) {
  if (options.sheets) row.insert(row.begin() + 1, sheet);
  return row;
}

std::string regionName(const map::RegionStatistics& region) {
  return region.region.empty() ? map::kWholeMatrix : region.region;
}

}  // namespace fsr::exports
