#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::dataset {

/// Section of a scan that belongs to none, because its pressure is not finite.
constexpr std::uint32_t kNoSection = 0xffffffff;

/// The parts of a recording that cross-validation holds out, one after the other.
///
/// Each condition of a recording is divided into sections that are contiguous in time. They begin where a
/// cycle begins, so that no cycle is on both sides of a split. Section k of all conditions is held out
/// together. A condition with fewer cycles than sections is divided by number of scans instead, and a warning
/// says that its scores are too good.
struct Sections {
  std::size_t number = 0;                            ///< number of sections
  std::vector<std::uint32_t> section;                ///< of each scan, 0 .. number - 1, or kNoSection
  std::vector<std::uint32_t> cycle;                  ///< of each scan, counted within its condition
  std::vector<statistics::LoadDirection> direction;  ///< of each scan
  std::vector<std::size_t> cycles;                   ///< number of cycles of each condition
  std::vector<std::uint8_t> dwell;                   ///< of each scan, see dwellsOf()
  std::vector<std::string> warnings;
};

/// Divides a recording, which must have a chamber pressure, into `number` sections.
Sections divideIntoSections(const Recording& recording, std::size_t number);

}  // namespace fsr::dataset
