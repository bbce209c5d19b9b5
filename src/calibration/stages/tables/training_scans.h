#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/fit_scheme.h"
#include "compensation/training_statistics.h"
#include "dataset/count_readers.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "regression/code_statistics.h"

namespace fsr::calibration {

/// Scans of one recording that follow each other, with the same curvature class, section and session.
struct TrainingRun {
  std::uint32_t recording = 0;
  std::uint32_t section = 0;
  std::size_t first = 0, end = 0;                   ///< scans of the recording
  std::size_t first_cycle = 0;                      ///< of the condition among the cycles of its class
  const regression::FixedPressure* zero = nullptr;  ///< of all taxels in the session; null = 0

  regression::FixedPressure zeroOf(std::size_t taxel) const { return zero == nullptr ? 0 : zero[taxel]; }
};

/// The number of a cycle of its class as TrainingScan holds it. All cycles beyond 65,535 have that number.
inline std::uint16_t cycleNumber(std::size_t number) {
  return static_cast<std::uint16_t>(number < 0xffff ? number : 0xffff);
}

/// One reading of a taxel in the training.
struct TrainingScan {
  std::uint16_t code = 0;
  regression::FixedPressure pressure = 0;  ///< of the chamber
  statistics::LoadDirection direction = statistics::LoadDirection::kNone;
  bool dwell = false;       ///< the loaded chamber holds its pressure
  std::uint16_t cycle = 0;  ///< see cycleNumber()
};

/// What a table answers too much in a session, for each taxel: [recordings][conditions][taxels]. Empty at any
/// level = 0.
using SessionZeros = std::vector<std::vector<std::vector<regression::FixedPressure>>>;

/// The scans that have a pressure, by curvature class and section; within a section in the order of the
/// recordings and of time. The recordings must outlive them.
struct TrainingScans {
  const std::vector<dataset::Recording>* recordings = nullptr;
  std::vector<std::vector<regression::FixedPressure>>
      pressure;  ///< of the chamber in runs, [recordings][scans]
  std::vector<std::vector<TrainingRun>> of_class;

  /// Calls visit(count, pressure of the chamber) for each scan of a run. `counts`: of the taxel in each
  /// recording.
  template <typename Visit>
  void forEach(const TrainingRun& run, std::vector<dataset::TaxelCounts>& counts, Visit visit) const {
    for (std::size_t i = run.first; i < run.end; ++i)
      visit(counts[run.recording][i], pressure[run.recording][i]);
  }
  /// Calls visit(TrainingScan) likewise. `divided`: the recordings in sections.
  template <typename Visit>
  void forEachScan(const TrainingRun& run, std::vector<dataset::TaxelCounts>& counts,
                   const std::vector<dataset::Sections>& divided, Visit visit) const {
    const dataset::Sections& sections = divided[run.recording];
    for (std::size_t i = run.first; i < run.end; ++i) {
      visit(TrainingScan{counts[run.recording][i], pressure[run.recording][i], sections.direction[i],
                         sections.dwell[i] != 0, cycleNumber(run.first_cycle + sections.cycle[i])});
    }
  }
};

/// The number of the first cycle of each condition among the cycles of its class: [recordings][conditions].
/// A condition whose pressure never changes counts as one cycle.
std::vector<std::vector<std::size_t>> firstCycles(const dataset::ConditionClasses& classes,
                                                  const std::vector<dataset::Sections>& sections);

/// `sections` has one entry for each recording. The runs point into `zeros`.
TrainingScans gatherScans(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections, const SessionZeros& zeros);

/// The statistics of one taxel, [classes x sections]. A table shall answer the chamber pressure and the zero,
/// which a tare subtracts again.
std::vector<regression::CodeStatistics> statisticsOfTaxel(const TrainingScans& scans, std::size_t sections,
                                                          std::uint16_t full_scale, std::size_t taxel);

/// The readings of one taxel, one by one, [classes][sections].
std::vector<std::vector<regression::CodeSamples>> samplesOfTaxel(const TrainingScans& scans,
                                                                 std::size_t sections,
                                                                 std::uint16_t full_scale, std::size_t taxel);

/// The readings of one taxel in the form that crossValidateScheme() takes: sums, and single readings where
/// the regressor needs them.
compensation::SectionedReadings sectionedReadings(const TrainingScans& scans, std::size_t sections,
                                                  std::uint16_t full_scale, std::size_t taxel,
                                                  const regression::RegressorOptions& regressor);

}  // namespace fsr::calibration
