#include "exports/statistics_table.h"

namespace fsr::exports {

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

}  // namespace

StatisticsTable::StatisticsTable(const std::string& path, const StatisticsOptions& options)
    : options_(options),
      factor_(1 / view::pascals(options.unit)),
      reader_(options),
      table_(openRowTable(path, "statistics",
                          withSheet(statisticsColumns(view::name(options.unit)), options))) {}

void StatisticsTable::begin(const ExportSubject& subject) {
  reader_.begin(subject);
  bag_ = subject.name;
  sheet_ = subject.sheet;
}

void StatisticsTable::add(const ScanRecord& scan) {
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

}  // namespace fsr::exports
