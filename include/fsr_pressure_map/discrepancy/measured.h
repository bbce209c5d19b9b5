#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr {

/// A stay of the matrix on one surface: scans first .. last - 1.
struct Visit {
  std::size_t recording = 0;
  Surface surface;
  std::size_t curvature_class = 0;
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Which use the scans of a cycle serve. What is shown at the end takes no part in anything before.
enum class CycleUse : std::uint8_t { kFit, kShow };

/// One filling and venting.
struct MeasuredCycle {
  std::size_t visit = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::uint32_t fold = 0;  ///< for choosing between explanations: 0 .. kFolds - 1, interleaved
  CycleUse use = CycleUse::kFit;
};

/// All recordings of a problem as one course of events, scans in time order.
struct Measured {
  static constexpr std::uint32_t kFolds = 4;

  const std::vector<Recording>* recordings = nullptr;
  Layout layout;
  double full_scale = 0;                ///< [counts]
  std::vector<CurvatureClass> classes;  ///< by ascending curvature of taxel 0
  std::vector<Visit> visits;
  std::vector<MeasuredCycle> cycles;
  std::vector<std::uint8_t> used;  ///< of each taxel; 0 = masked or faulty

  std::vector<double> time;              ///< since the first scan of the first recording [s]
  std::vector<double> pressure;          ///< gauge, its noise smoothed away where it runs straight [Pa]
  std::vector<double> rate;              ///< [Pa/s]
  std::vector<double> temperature;       ///< [degree Celsius]; empty where a recording has none
  std::vector<double> way;               ///< sum of |dP| since the first scan [Pa]
  std::vector<std::uint32_t> visit;      ///< of each scan
  std::vector<std::uint32_t> cycle;      ///< of each scan
  std::vector<std::int8_t> direction;    ///< +1 loading, -1 unloading, 0 = never changes
  std::vector<std::string> limitations;  ///< sentences

  std::size_t scans() const { return time.size(); }
  std::size_t taxels() const { return layout.size.taxels(); }
  std::size_t usedTaxels() const;
  std::size_t classOf(std::size_t scan) const { return visits[visit[scan]].curvature_class; }
  const std::uint16_t* counts(std::size_t scan) const {
    const Visit& at = visits[visit[scan]];
    return (*recordings)[at.recording].scan(scan - at.first + first_in_recording[visit[scan]]);
  }
  std::vector<std::size_t> first_in_recording;  ///< scan of the recording with which each visit begins
};

/// Puts the recordings in order of time, finds visits and cycles, and parts the cycles, by the seed,
/// into those to fit on and those to show on. The recordings must outlive it. Throws InputError where
/// they cannot be judged.
Measured admit(const DiscrepancyProblem& problem);

/// A course of pressure [Pa] without its noise: where it runs straight over some scans, the straight
/// line, beside corners from the straight side alone. `rate` becomes its slope [Pa/s].
std::vector<double> smoothCourse(const std::vector<double>& time, const std::vector<double>& pressure,
                                 std::vector<double>& rate);

}  // namespace fsr
