#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/dataset/sections.h"
#include "regression/code_statistics.h"
#include "study/study_plan.h"

namespace fsr::study {

/// One scan as the study uses it.
struct StudyScan {
  const std::uint16_t* counts = nullptr;  ///< of all taxels, inside its recording
  regression::FixedPressure pressure = 0;
  double time = 0;  ///< since the start of its recording [s]
  std::uint32_t section = 0;
  std::uint32_t cycle = 0;      ///< numbered through all recordings and conditions
  bool first_cycle = false;     ///< of its condition
  std::uint32_t mount = 0;      ///< numbered through all recordings, by surface and mount
  std::uint32_t recording = 0;  ///< index
  statistics::LoadDirection direction = statistics::LoadDirection::kNone;
};

/// All recordings together. Points into them: they must outlive it.
struct StudyData {
  std::vector<dataset::CurvatureClass> classes;  ///< by ascending curvature
  std::vector<std::vector<StudyScan>> scans;     ///< of each class, by recording and time
  std::size_t sections = 0;
  std::size_t cycles = 0;
  std::size_t mounts = 0;
  std::uint16_t full_scale = 0;
  std::size_t matrix_taxels = 0;
  std::vector<std::size_t> taxels;  ///< that take part: not masked, and varying on every class
  double lowest = 0;                ///< pressure of all scans [Pa]
  double highest = 0;               ///< [Pa]
  std::vector<std::string> warnings;

  std::size_t scanCount() const;
  /// Index of the flat class. Throws InputError where there is none.
  std::size_t flatClass() const;
};

/// Throws InputError where the recordings are none, not of one matrix, without pressure or curvature, or
/// where no taxel varies.
StudyData gatherStudyData(const std::vector<dataset::Recording>& recordings, std::size_t sections);

/// The scans of each class in groups of which some are held out: sections, mounts. Indices into
/// StudyData::scans, ascending; a scan may be in no group.
struct Grouping {
  std::size_t groups = 0;
  std::vector<std::vector<std::vector<std::uint32_t>>> scans;  ///< [class][group][...]
};

Grouping bySection(const StudyData& data);
Grouping byMount(const StudyData& data);

/// `whole` with one of `one_of[class]` scans of each group left, 0 = none of that class. Draws depend on
/// seed, class, group and share alone, so that methods of one share see the same scans.
Grouping downSampled(const Grouping& whole, const std::vector<std::size_t>& one_of, DownSampling rule,
                     std::uint64_t seed);

}  // namespace fsr::study
