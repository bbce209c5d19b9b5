#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::discrepancy {

/// Thresholds that several files share. A threshold that only one file uses stands in that file.
namespace thresholds {

/// Share of the readings' squared error. An effect, a pattern or a group of taxels that explains less does
/// not matter.
constexpr double kLeastShareOfError = 0.02;
/// Share of the largest root mean square. A taxel, a class of curvature or a mount with less does not show
/// the effect.
constexpr double kShows = 0.2;
/// The same for a bin of pressure.
constexpr double kPressureShows = 0.25;
/// Width of a bin of pressure [Pa].
constexpr double kPressureBin = 25e3;
/// Share of the highest pressure. Below it the sheet counts as unloaded.
constexpr double kLoaded = 0.1;
/// Smallest range of the chamber pressure [Pa].
constexpr double kLeastRange = 10e3;

/// At least half of the taxels must be usable: detectors compare a taxel with the others.
constexpr bool enoughUsable(std::size_t usable, std::size_t taxels) {
  return 2 * usable >= taxels;
}

}  // namespace thresholds

/// Recordings that are sound, but have too few cycles to compare. A question about an effect has an answer
/// all the same: these recordings cannot show it.
class TooFewCycles : public settings::InputError {
 public:
  using InputError::InputError;
};

/// A stay of the matrix on one surface: samples first .. last - 1.
struct Visit {
  std::size_t recording = 0;
  matrix::Surface surface;
  std::size_t curvature_class = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t first_scan = 0;     ///< of the recording
  std::size_t last_scan = 0;      ///< likewise, excluded
  double reference_interval = 0;  ///< of its recording [s]
};

/// How a cycle is used. The final results are measured on the hold-out cycles, which serve nothing else.
enum class CycleUse : std::uint8_t { kFit, kHoldOut };

/// One filling and venting: samples first .. last - 1.
struct MeasuredCycle {
  std::size_t visit = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  CycleUse use = CycleUse::kFit;
};

/// All recordings of a problem, in order of time. A sample is one scan or the mean of a few consecutive
/// scans. Scans are pooled to save computing time; the effects of interest are slower than the scans.
struct Measured {
  static constexpr std::size_t kManySamples = 14000;  ///< with more, scans are pooled, up to kLongestSample
  static constexpr double kLongestSample = 0.5;       ///< longest time over which scans are pooled [s]

  const std::vector<dataset::Recording>* recordings = nullptr;
  /// The same with every scan, to drive simulations; nullptr = the recordings have every scan.
  const std::vector<dataset::Recording>* whole = nullptr;
  std::shared_ptr<const simulation::EffectLibrary> library;  ///< effects of the simulation
  matrix::Layout layout;
  double full_scale = 0;                         ///< [counts]
  std::vector<dataset::CurvatureClass> classes;  ///< by ascending curvature of taxel 0
  std::vector<Visit> visits;
  std::vector<MeasuredCycle> cycles;
  std::vector<std::uint8_t> used;  ///< for each taxel; 0 = masked or faulty

  // For each sample, in order of time:
  std::vector<double> time;          ///< since the first scan of the first recording [s]
  std::vector<double> pressure;      ///< gauge pressure, smoothed where its course is straight [Pa]
  std::vector<double> raw_pressure;  ///< gauge pressure as recorded [Pa]
  std::vector<double> rate;          ///< [Pa/s]
  std::vector<double> temperature;   ///< [degree Celsius]; empty where a recording has none
  std::vector<double> path_length;   ///< sum of |dP| since the first sample [Pa]
  std::vector<std::uint32_t> visit;
  std::vector<std::uint32_t> cycle;
  std::vector<std::int8_t> direction;   ///< +1 = loading, -1 = unloading, 0 = pressure never changes
  std::vector<std::size_t> first_scan;  ///< of the visit's recording
  std::vector<std::uint32_t> scans;     ///< number of scans in the sample
  /// Sum of the counts of the sample's scans, [samples x taxels]. Copies share it.
  std::shared_ptr<const std::vector<std::uint32_t>> sums;

  // Effects that were subtracted, for each sample; empty = none.
  std::vector<double> load;   ///< on the taxels, from the chamber pressure and its history [Pa]
  std::vector<double> gain;   ///< factor of the readings above `unloaded`
  std::vector<double> added;  ///< added to the readings [share of full scale]
  double unloaded = 0;        ///< reading without load [share of full scale]

  std::vector<std::string> limitations;  ///< sentences

  std::size_t samples() const { return time.size(); }
  std::size_t taxels() const { return layout.size.taxels(); }
  double range() const;  ///< highest less lowest pressure [Pa]
  std::size_t usedTaxels() const;
  std::size_t fitCycles() const;
  /// What the static curves are functions of, at each sample: `load`, or `pressure` where nothing was
  /// subtracted [Pa].
  const std::vector<double>& loads() const;
  /// Number of times that each class of curvature was mounted. Visits with the same label of a mount are one
  /// mount; each visit without a label is a mount of its own.
  std::vector<std::size_t> mounts() const;
  const simulation::EffectLibrary& effects() const;
  const simulation::EffectInfo& info(const std::string& effect) const;
  std::size_t classOf(std::size_t sample) const { return visits[visit[sample]].curvature_class; }
  /// Mean reading of every taxel as it was recorded [share of full scale], [taxels], row-major.
  void recorded(std::size_t sample, std::vector<double>& result) const;
  /// The same without the gain and the added reading of the effects that were subtracted.
  void readings(std::size_t sample, std::vector<double>& result) const;
};

/// Puts the recordings in order of time and finds visits and cycles. The seed determines which cycles are
/// held out and which are fitted. The recordings must outlive the result. Throws InputError if the recordings
/// cannot be judged.
Measured admit(const DiscrepancyProblem& problem);

/// Smooths a course of pressure [Pa]. Where the course is straight over some scans, the result is a straight
/// line through them. Beside a corner the line uses scans of one side only. `rate` receives the slope [Pa/s].
std::vector<double> smoothCourse(const std::vector<double>& time, const std::vector<double>& pressure,
                                 std::vector<double>& rate);

/// Throws InputError where the reference of a recording does not belong to its readings: they change while it
/// stays, fall where it rises, or do not follow it. Such a recording would make a static curve of its own,
/// and nothing would be noticed.
void requireReference(const Measured& measured);

}  // namespace fsr::discrepancy
