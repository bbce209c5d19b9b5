#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// A table of one taxel over its codes, in the form that a recheck reads.
struct AnswerTable {
  std::vector<float> pressure;   ///< [codes] [Pa]; empty = the taxel has no model
  std::vector<float> deviation;  ///< [codes] [Pa]

  /// Linear between the codes, constant beyond them.
  double pressureAt(double code) const { return at(pressure, code); }
  double deviationAt(double code) const { return at(deviation, code); }
  /// Change of the pressure with the code, over a window of a few codes [Pa/count].
  double slopeAt(double code) const;

  static double at(const std::vector<float>& values, double code);
};

/// One reading of a taxel with the pressure that its table should answer.
struct RecheckReading {
  std::uint16_t code = 0;
  std::uint32_t cycle = 0;  ///< index into RecheckReadings::stay_of_cycle
  float pressure = 0;       ///< [Pa]
};

/// The readings of a recheck, sorted by taxel and by cycle.
struct RecheckReadings {
  /// One stay of the sheet on a surface: a condition of a recording.
  struct Stay {
    std::size_t surface = 0;           ///< index into `surfaces`
    std::uint32_t mount = 0;           ///< number of the mount; 0 = not given
    std::vector<AnswerTable> answers;  ///< [taxels], the tables of the parent on this surface
    /// [taxels], readings at rest at the start, whose error a tare subtracts; empty = no tare.
    std::vector<std::vector<RecheckReading>> rest;
  };
  std::vector<Stay> stays;
  std::vector<std::size_t> stay_of_cycle;             ///< [cycles]
  std::vector<std::vector<RecheckReading>> readings;  ///< [taxels], cycle after cycle
  /// [taxels][cycles + 1], index of the first reading of each cycle, and the number of readings.
  std::vector<std::vector<std::size_t>> first;
  std::vector<std::string> surfaces;  ///< names, each once
  std::vector<std::string> remarks;   ///< sentences for the user

  std::size_t cycles() const { return stay_of_cycle.size(); }
  const Stay& stayOf(std::size_t cycle) const { return stays[stay_of_cycle[cycle]]; }
};

/// A recheck needs at least so many cycles, so that one can be left out and two tell their scatter.
constexpr std::size_t kLeastCycles = 3;
/// Pressures of one cycle [Pa].
struct CycleSpan {
  double first = 0, last = 0, low = 0, high = 0;
  bool empty = true;

  void include(double pressure);
  double width() const { return high - low; }
  /// Whether the cycle counts in a recheck: its pressures span `least` [Pa], and it begins and ends in the
  /// lowest quarter of them. A loading without its unloading would take the sheet's loop for a change.
  bool counts(double least) const;
};

/// The least span of a cycle that counts: three quarters of the trained range [Pa]. A smaller cycle runs
/// through another loop of the sheet than those of the training, which looks like a change, and gain and
/// offset cannot be told apart at one pressure.
double leastCycleSpan(const Calibration& parent);

/// Number of cycles in a series of pressures [Pa] that count. `running`: whether the last one does, although
/// it may not have ended.
std::size_t countCycles(const std::vector<double>& pressure, double least, bool& running);

/// Reads the counts once. Readings of 0 counts and of full scale are left out, because they are limits.
/// Throws InputError, one sentence, where the recordings do not fit the parent: matrix, converter, board,
/// surface, pressure reference, number of cycles, range of pressure.
RecheckReadings gatherRecheck(const Calibration& parent, const std::vector<dataset::Recording>& recordings);

}  // namespace fsr::calibration
