#pragma once

#include <cstdint>

/// Tables that scripts/view_tables.py writes.
namespace fsr::view::tables {

extern const std::uint8_t kViridis[256 * 3];  ///< red, green, blue of each step
extern const std::uint8_t kCividis[256 * 3];

/// Glyphs of ASCII 32 to 126, 13 rows each from the top; bit x is the pixel x of 7 from the left.
extern const std::uint8_t kFont[95 * 13];

}  // namespace fsr::view::tables
