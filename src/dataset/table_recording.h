#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/table_reader.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// Meaning of a column of a table.
enum class ColumnRole {
  kTime,
  kReading,
  kReference,
  kReferenceTime,
  kCurvature,
  kTemperature,
  kSurface,
  kMount
};

struct TableColumn {
  ColumnRole role = ColumnRole::kTime;
  std::string column;  ///< its name, or its number counted from 1; FIRST-LAST for several readings
  std::string unit;    ///< empty = the first in the list of parseColumns()
};

/// Reads "time=1:ms,reading=force_V:V,reference=pressure_bar:bar": ROLE=COLUMN[:UNIT], separated by
/// commas. Throws InputError. Roles and units:
///
///     time         s, ms, us, min
///     reading      counts, V, mV, S, mS, uS, ohm, kohm, Mohm; each is one taxel, row-major;
///                  c5-c84 = all columns from c5 to c84
///     reference    kPa, Pa, MPa, bar, mbar, psi, mmHg; N (by the area); e.g. 2500Pa for each unit
///     reference_time  s, ms, us, min: of a reference that was recorded by itself
///     curvature    1/m, 1/cm
///     temperature  C, K, F
///     surface      its name, as text
///     mount        its number
std::vector<TableColumn> parseColumns(const std::string& text);

/// Conversion of readings to counts: counts = 65535 (reading - low) / (high - low). Counts are not converted,
/// unless a range is given. For readings that fall with increasing pressure, low is above high.
struct ReadingScale {
  double low = 0;
  double high = 0;
  std::string unit;  ///< counts, V or S; resistances are converted to conductances
  std::uint16_t full_scale = 65535;

  std::string text() const;  ///< e.g. "65535 counts = 5 V"
};

struct TablePlan {
  std::vector<TableColumn> columns;
  TableFormat format;
  matrix::MatrixSize matrix;  ///< 0 x 0 = one row of all readings
  double pitch = 0.010;       ///< [m]
  std::optional<std::pair<double, double>>
      range;  ///< range of the readings [counts, V or S]; none = 0 to a round number above the largest
  std::optional<std::uint16_t>
      full_scale;      ///< of readings in counts; none = 4095, or 65535 where a reading is larger
  double area = 1e-4;  ///< on which a force acts [m^2]
  std::optional<double> ambient_pressure;  ///< if given, the reference is absolute [Pa]
  std::optional<double> curvature;         ///< of the surface, where no column contains it [1/m]
  std::string surface;                     ///< its name
  /// Stamp of time 0 [ns]; none = 2000-01-01, or 1970-01-01 if the first time is a Unix time.
  std::optional<std::int64_t> start_ns;
  std::optional<double>
      reference_rate;           ///< of a reference that has no time [1/s]; it begins with the first row
  double reference_offset = 0;  ///< added to the times of the reference [s]
  bool skip_bad_rows = false;   ///< skip rows that would be refused
};

struct TableRecording {
  Recording recording;
  ReadingScale scale;
  std::optional<double> area;  ///< by which the newtons of the reference were divided [m^2]
  std::uint64_t skipped = 0;   ///< skipped rows
  std::uint64_t no_reference =
      0;                   ///< scans before or after a reference that was recorded by itself, left out
  bool unix_time = false;  ///< the times are seconds since 1970
};

/// Reads a table as a recording. Throws InputError, with file, line and column, where a cell is not a number
/// or the time does not increase, and where the plan does not fit the table.
TableRecording readTable(const std::string& path, const TablePlan& plan);

/// Conversion of a column to SI: factor * (value + offset), or the inverse of that.
struct TableUnit {
  double factor = 1;
  double offset = 0;
  std::string quantity = {};  ///< for roles with several quantities: counts, V, S; N of a reference
  bool inverse = false;       ///< resistance -> conductance
};

/// Throws InputError where the column's role has no such unit.
TableUnit unitOf(const TableColumn& column);

}  // namespace fsr::dataset
