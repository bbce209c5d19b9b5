#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/dataset/sections.h"
#include "regression/code_samples.h"
#include "regression/code_statistics.h"

namespace fsr::calibration {

/// One scan as training uses it.
struct TrainingScan {
  const std::uint16_t* counts = nullptr;  ///< of all taxels, inside its recording
  regression::FixedPressure pressure = 0;
  std::uint32_t section = 0;
  statistics::LoadDirection direction = statistics::LoadDirection::kNone;
};

/// The scans with a pressure, by curvature class, section after section, within one in the order of the
/// recordings and of time. They point into the recordings, which must outlive them.
using TrainingScans = std::vector<std::vector<TrainingScan>>;

/// `sections` has one entry for each recording.
TrainingScans gatherScans(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections);

/// The statistics of one taxel: one cell for each class and section, section after section.
std::vector<regression::CodeStatistics> statisticsOfTaxel(const TrainingScans& scans, std::size_t sections,
                                                          std::uint16_t full_scale, std::size_t taxel);

/// Its readings one by one, [classes][sections].
std::vector<std::vector<regression::CodeSamples>> samplesOfTaxel(const TrainingScans& scans,
                                                                 std::size_t sections,
                                                                 std::uint16_t full_scale, std::size_t taxel);

}  // namespace fsr::calibration
