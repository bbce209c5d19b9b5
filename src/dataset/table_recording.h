#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/table_reader.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// What a column of a table means.
enum class ColumnRole { kTime, kReading, kReference, kCurvature, kTemperature, kSurface, kMount };

struct TableColumn {
  ColumnRole role = ColumnRole::kTime;
  std::string column;  ///< name, or number counted from 1
  std::string unit;    ///< empty = the first of the list below
};

/// Reads "time=1:ms,reading=force_V:V,reference=pressure_bar:bar": ROLE=COLUMN[:UNIT], separated by
/// commas. Throws InputError. Roles and units:
///
///     time         s, ms, us, min
///     reading      counts, V, mV, S, mS, uS, ohm, kohm, Mohm; each is one taxel, row-major
///     reference    kPa, Pa, MPa, bar, mbar, psi, mmHg; N (by the area); e.g. 2500Pa for each unit
///     curvature    1/m, 1/cm
///     temperature  C, K, F
///     surface      its name, as text
///     mount        its number
std::vector<TableColumn> parseColumns(const std::string& text);

/// How readings become counts: counts = 65535 (reading - low) / (high - low). Counts stay as they are. A
/// reading that falls with the pressure has its low above its high.
struct ReadingScale {
  double low = 0;
  double high = 0;
  std::string unit;  ///< counts, V or S; resistances become conductances
  std::uint16_t full_scale = 65535;

  std::string text() const;  ///< e.g. "65535 counts = 5 V"
};

struct TablePlan {
  std::vector<TableColumn> columns;
  TableFormat format;
  matrix::MatrixSize matrix;  ///< 0 x 0 = one row of all readings
  double pitch = 0.010;       ///< [m]
  std::optional<std::pair<double, double>>
      range;  ///< of the readings, in V or S; none = 0 to a round number above the largest
  std::optional<std::uint16_t>
      full_scale;      ///< of readings that are counts; none = 4095, or 65535 where some are larger
  double area = 1e-4;  ///< that a force acts on [m^2]
  std::optional<double> ambient_pressure;      ///< given = the reference is absolute [Pa]
  std::optional<double> curvature;             ///< of a surface that no column tells of [1/m]
  std::string surface;                         ///< its name
  std::int64_t start_ns = 946684800000000000;  ///< stamp of time 0: 2000-01-01 [ns]
  bool skip_bad_rows = false;                  ///< leave out rows that would be refused
};

struct TableRecording {
  Recording recording;
  ReadingScale scale;
  std::uint64_t skipped = 0;  ///< rows left out
};

/// Throws InputError, with file, line and column, where a cell is no number or the time does not move on,
/// and where the plan does not fit the table.
TableRecording readTable(const std::string& path, const TablePlan& plan);

}  // namespace fsr::dataset
