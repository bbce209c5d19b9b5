#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/alarm.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::map {

/// A named part of the matrix, with its alarm.
struct Region {
  std::string name;  ///< "" = the whole matrix
  std::vector<std::uint8_t>
      mask;  ///< [rows x columns], row-major, 1 = part of the region; empty = every taxel
  AlarmOptions alarm;

  bool has(std::size_t taxel) const { return mask.empty() || mask[taxel] != 0; }
};

/// Reads a region file. A region is a rectangle, or a mask with one line for each row:
///
///     alarm: {threshold: 250e3, dwell: 1.0, hysteresis: 20e3}   # of the whole matrix, optional [Pa, s, Pa]
///     regions:
///       - name: patellar_tendon
///         rows: [0, 2]         # first and last, counted from 0
///         columns: [3, 6]
///       - name: fibula_head
///         mask: |              # 1 = part of the region, 0 or . = not
///           0011000000
///           0111000000
///         alarm: {threshold: 120e3, dwell: 2.0}
///
/// The first region of the result is the whole matrix, with the name "". Throws InputError.
std::vector<Region> readRegionFile(const std::string& path, matrix::MatrixSize size);
/// Reads the same from text. `origin`: name that messages give instead of a file.
std::vector<Region> readRegions(const std::string& yaml, const std::string& origin, matrix::MatrixSize size);

}  // namespace fsr::map
