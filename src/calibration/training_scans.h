#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/fit_scheme.h"
#include "compensation/training_statistics.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "regression/code_samples.h"
#include "regression/code_statistics.h"

namespace fsr::calibration {

/// One scan of the training.
struct TrainingScan {
  const std::uint16_t* counts = nullptr;  ///< of all taxels, in the memory of its recording
  regression::FixedPressure pressure = 0;
  std::uint32_t section = 0;
  statistics::LoadDirection direction = statistics::LoadDirection::kNone;
  const regression::FixedPressure* zero = nullptr;  ///< of all taxels in its session; null = 0

  regression::FixedPressure zeroOf(std::size_t taxel) const { return zero == nullptr ? 0 : zero[taxel]; }
  /// What the table shall answer: the chamber pressure and the zero, which a tare subtracts again.
  regression::FixedPressure target(std::size_t taxel) const { return pressure + zeroOf(taxel); }
};

/// What a table answers too much in a session, for each taxel: [recordings][conditions][taxels]. Empty at any
/// level = 0.
using SessionZeros = std::vector<std::vector<std::vector<regression::FixedPressure>>>;

/// The scans that have a pressure, by curvature class and section; within a section in the order of the
/// recordings and of time. They point into the recordings, which must outlive them.
using TrainingScans = std::vector<std::vector<TrainingScan>>;

/// `sections` has one entry for each recording. The scans point into `zeros`, too.
TrainingScans gatherScans(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections, const SessionZeros& zeros);

/// The statistics of one taxel, [classes x sections].
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
