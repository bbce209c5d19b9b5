#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::dataset {

/// Indices of the recordings in the order of their first stamps. Recordings that begin at the same time keep
/// their order.
std::vector<std::size_t> inOrderOfTime(const std::vector<Recording>& recordings);

/// Whether the sheet lay on between two recordings: the second begins after the end of the first, within an
/// hour, on the same sensor, surface and mount.
bool sheetLayOn(const Recording& before, const Recording& after);

/// How far the pressure must return before a peak or a valley counts.
struct CycleOptions {
  double share_of_range = 0.05;  ///< share of (largest - smallest pressure of the series)
  double least = 2e3;            ///< and at least this, so that noise makes no cycle [Pa]
};

/// Fill and vent cycles of a chamber. A cycle runs from one valley to the next.
struct Cycles {
  std::vector<std::size_t> first;  ///< index of each cycle's first reading; first[0] = 0
  std::vector<statistics::LoadDirection>
      direction;  ///< of each reading; kNone where the pressure never changes

  std::size_t count() const { return first.size(); }
};

/// Finds the cycles of `pressure` [Pa], which must be finite and in the order of time. A series that is empty
/// or never changes has no cycle. A single rise or fall is one cycle.
Cycles findCycles(const std::vector<double>& pressure, const CycleOptions& options = {});

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

/// Coverage of given classes. `sections` has one entry for each recording.
Coverage measureCoverage(const std::vector<Recording>& recordings, const ConditionClasses& classes,
                         const std::vector<Sections>& sections);

}  // namespace fsr::dataset
