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

namespace {

std::vector<TableColumn> statisticsColumns(const std::string& unit) {
  return {{"bag", "", "base name of the recording", true},
          {"session", "", "session id", true},
          {"surface", "", "under the matrix", true},
          {"mount", "", "number of the mount"},
          {"cycle", "", "cycle of the chamber's pressure, from 1"},
          {"event", "", "last event so far, kind or kind:label", true},
          {"time", "s", "since the first scan", false, 12},
          {"stamp", "s", "since 1970, UTC", false, 16},
          {"region", "", "whole_matrix, or its name in the region file", true},
          {"peak", unit, "highest reading"},
          {"peak_deviation", unit, "one standard deviation of that reading"},
          {"peak_row", "", "row of its taxel, from 0"},
          {"peak_column", "", "column of its taxel, from 0"},
          {"mean", unit, "over the taxels with a reading, weighted by area"},
          {"mean_contact", unit, "over the contact area"},
          {"mean_contact_deviation", unit, "upper limit: as if taxels deviated together"},
          {"force", "N", "sum of pressure x area over the contact area"},
          {"force_deviation", "N", "upper limit: as if taxels deviated together"},
          {"contact_area", "cm2", "of the taxels in contact"},
          {"centre_x", "mm", "centre of pressure on the flat sheet"},
          {"centre_y", "mm", "centre of pressure on the flat sheet"},
          {"integral", unit + " s", "pressure-time integral of the taxel with the largest one, so far"},
          {"at_least", "",
           "taxels whose pressure is at least their reading; above 0, peak, mean and force are >="},
          {"without_reading", "", "taxels without a reading; masked ones are not counted"},
          {"state", "", "state of the whole map", true}};
}

// A table with one row for each region and scan. HDF5 holds units and meanings of the columns.
class StatisticsTable : public ScanSink {
 public:
  StatisticsTable(const std::string& path, const StatisticsOptions& options)
      : options_(options),
        factor_(1 / view::pascals(options.unit)),
        reader_(options),
        table_(openRowTable(path, "statistics",
                            withSheet(statisticsColumns(view::name(options.unit)), options))) {}

  void begin(const ExportSubject& subject) override {
    reader_.begin(subject);
    bag_ = subject.name;
    sheet_ = subject.sheet;
  }

  void add(const ScanRecord& scan) override {
    constexpr double kNone = ScanRecord::kUnknown;
    const bool mounted = scan.surface != nullptr && scan.surface->mount != 0;
    for (const RegionReading& reading : reader_.read(scan)) {
      const map::RegionStatistics& of = reading.of;
      const bool peak = !std::isnan(of.peak);
      table_->add(withSheet({bag_,
                             scan.session,
                             scan.surface ? scan.surface->name : "",
                             mounted ? double(scan.surface->mount) : kNone,
                             scan.cycle ? double(*scan.cycle) : kNone,
                             scan.event,
                             1e-9 * double(scan.since_ns),
                             1e-9 * double(scan.stamp_ns),
                             regionName(of),
                             of.peak * factor_,
                             reading.peak_deviation * factor_,
                             peak ? double(scan.layout.row(of.peak_taxel)) : kNone,
                             peak ? double(scan.layout.column(of.peak_taxel)) : kNone,
                             reading.mean_of_all * factor_,
                             of.mean * factor_,
                             reading.mean_deviation * factor_,
                             of.force,
                             reading.force_deviation,
                             of.contact_area * 1e4,
                             of.centre ? of.centre->x * 1e3 : kNone,
                             of.centre ? of.centre->y * 1e3 : kNone,
                             of.pressure_time_integral * factor_,
                             double(of.at_least),
                             double(of.bad),
                             stateWord(scan.map->state)},
                            sheet_, options_));
    }
  }

  void finish() override { table_->finish(); }

 private:
  StatisticsOptions options_;
  double factor_;  // of pressures in the table [unit / Pa]
  RegionReader reader_;
  std::unique_ptr<RowTable> table_;
  std::string bag_, sheet_;
};

}  // namespace

std::unique_ptr<ScanSink> openStatistics(const std::string& output, const StatisticsOptions& options) {
  return std::make_unique<StatisticsTable>(output, options);
}

}  // namespace fsr::exports
