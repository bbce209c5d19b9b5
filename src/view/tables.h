#pragma once

#include <cstdint>

/// Tables written by scripts/view_tables.py.
namespace fsr::view::tables {

extern const std::uint8_t kViridis[256 * 3];  ///< red, green, blue of each step
extern const std::uint8_t kCividis[256 * 3];

/// Glyphs of ASCII 32 to 126, 13 rows each, from the top. Bit x is pixel x from the left, of 7 pixels.
extern const std::uint8_t kFont[95 * 13];

}  // namespace fsr::view::tables
