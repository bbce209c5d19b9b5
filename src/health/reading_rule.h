#pragma once

#include <cstdint>
#include <optional>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::health {

/// The readings of a taxel in a stretch of scans, and the limits that they are held against, all in one unit.
struct Stretch {
  double low = 0, high = 0;  ///< smallest and largest reading
  double floor = 0;          ///< readings up to here are those of an open circuit
  double still = 0;          ///< a stuck reading changes by no more
  double full_scale = 0;
};

/// What the others did in the stretch, or what the taxel should have read by them.
struct Others {
  bool loaded = false;           ///< they were certainly loaded
  bool moved = false;            ///< they changed more than noise can
  bool loaded_and_rest = false;  ///< a load came or went while the taxel was at full scale
};

/// The rule by which a taxel is dead or stuck, live and in a recording: taxel_flag::kDead, kStuck, or 0 where
/// it is alive; nothing where the stretch shows nothing.
///
///     dead   it never rose above the floor, while the others were loaded
///     stuck  it kept its reading, neither floor nor full scale, while the others moved; or it stayed at full
///            scale (a short circuit) while a load came or went
///     alive  it rose above the floor and changed
inline std::optional<std::uint16_t> verdictOf(const Stretch& taxel, const Others& others) {
  using namespace map::taxel_flag;
  if (taxel.high <= taxel.floor) return others.loaded ? std::optional<std::uint16_t>(kDead) : std::nullopt;
  if (taxel.high - taxel.low > taxel.still) return std::uint16_t{0};
  const bool shown = taxel.high >= taxel.full_scale ? others.loaded_and_rest : others.moved;
  return shown ? std::optional<std::uint16_t>(kStuck) : std::nullopt;
}

}  // namespace fsr::health
