#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/protocols.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "regression/code_statistics.h"
#include "study/study_plan.h"

namespace fsr::study {

/// A scan of one of the recordings of a study.
struct ScanPlace {
  std::uint32_t recording = 0;  ///< index
  std::uint32_t number = 0;     ///< index in its recording
};

/// The scans begin to end - 1 of a recording.
struct ScanRun {
  std::uint32_t recording = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  std::uint32_t scans() const { return end - begin; }
};

/// Scans in the order in which they were added, kept as runs of neighbours: a list of whole cycles does not
/// grow with the number of their scans.
class ScanList {
 public:
  void add(const ScanPlace& scan) { add({scan.recording, scan.number, scan.number + 1}); }
  void add(const ScanRun& run);

  bool empty() const { return scans_ == 0; }
  std::size_t size() const { return scans_; }
  const std::vector<ScanRun>& runs() const { return runs_; }

  /// The scans at some places of the list, which ascend.
  ScanList picked(const std::vector<std::uint32_t>& places) const;

  /// Calls visit(ScanPlace) for each scan.
  template <typename Visit>
  void forEach(Visit visit) const {
    for (const ScanRun& run : runs_) {
      for (std::uint32_t i = run.begin; i < run.end; ++i) visit(ScanPlace{run.recording, i});
    }
  }

 private:
  std::vector<ScanRun> runs_;
  std::size_t scans_ = 0;
};

bool operator==(const ScanList& a, const ScanList& b);

/// The scans of all recordings. It points into the recordings, which must outlive it.
struct StudyData {
  std::vector<dataset::CurvatureClass> classes;  ///< by ascending curvature
  std::vector<ScanList> scans;                   ///< of each class, by recording and time
  std::size_t sections = 0;
  std::size_t cycles = 0;
  std::size_t mounts = 0;
  std::uint16_t full_scale = 0;
  std::size_t matrix_taxels = 0;
  std::vector<std::size_t> taxels;  ///< the studied taxels: not masked, and varying on every class
  double lowest = 0;                ///< lowest pressure of all scans [Pa]
  double highest = 0;               ///< highest pressure of all scans [Pa]
  std::vector<std::string> warnings;
  /// The recordings as a whole, for models that are driven by the course of time.
  const std::vector<dataset::Recording>* recordings = nullptr;
  std::vector<dataset::Sections> divided;          ///< [recordings]
  std::vector<std::vector<std::size_t>> class_of;  ///< [recordings][conditions]
  /// Number of the first cycle of each condition, through all recordings [recordings][conditions].
  std::vector<std::vector<std::uint32_t>> first_cycle;
  /// Number of the mount, through all recordings, by surface and mount [recordings][conditions].
  std::vector<std::vector<std::uint32_t>> mount_of;
  dataset::Protocols protocols;

  // Of one scan.
  std::size_t classOf(const ScanPlace& scan) const { return class_of[scan.recording][condition(scan)]; }
  double time(const ScanPlace& scan) const { return recording(scan).time[scan.number]; }  ///< [s]
  regression::FixedPressure fixedPressure(const ScanPlace& scan) const {
    return regression::toFixed(recording(scan).pressure[scan.number]);
  }
  /// As the statistics know it [Pa].
  double pressure(const ScanPlace& scan) const { return regression::fromFixed(fixedPressure(scan)); }
  std::uint32_t section(const ScanPlace& scan) const { return divided[scan.recording].section[scan.number]; }
  /// Numbered through all recordings and conditions.
  std::uint32_t cycle(const ScanPlace& scan) const {
    return first_cycle[scan.recording][condition(scan)] + divided[scan.recording].cycle[scan.number];
  }
  /// Whether it belongs to the first cycle of its condition.
  bool inFirstCycle(const ScanPlace& scan) const { return divided[scan.recording].cycle[scan.number] == 0; }
  std::uint32_t mount(const ScanPlace& scan) const { return mount_of[scan.recording][condition(scan)]; }
  /// Index into protocols.names, or dataset::Protocols::kOther.
  std::uint32_t protocol(const ScanPlace& scan) const {
    return protocols.of_scan[scan.recording][scan.number];
  }
  statistics::LoadDirection direction(const ScanPlace& scan) const {
    return divided[scan.recording].direction[scan.number];
  }

  std::size_t scanCount() const;
  /// Index of the flat class. Throws InputError if there is none.
  std::size_t flatClass() const;

 private:
  const dataset::Recording& recording(const ScanPlace& scan) const { return (*recordings)[scan.recording]; }
  std::uint32_t condition(const ScanPlace& scan) const { return recording(scan).condition[scan.number]; }
};

/// Throws InputError if there are no recordings, if they are of different matrices or have no pressure or
/// curvature, or if fewer than three taxels vary.
StudyData gatherStudyData(const std::vector<dataset::Recording>& recordings, std::size_t sections);

/// The scans of each class, divided into groups (sections, mounts or halves of protocols) that are held out
/// together, in the order of StudyData::scans. A scan may be in no group.
struct Grouping {
  std::size_t groups = 0;
  std::vector<std::vector<ScanList>> scans;  ///< [class][group]
};

Grouping bySection(const StudyData& data);
Grouping byMount(const StudyData& data);
/// Groups 2 p and 2 p + 1: every second cycle of protocol p, and the others. A bandwidth can then be chosen
/// by holding out half of the cycles where all but one protocol are held out.
Grouping byHalfProtocol(const StudyData& data);

/// Keeps one of `one_of[class]` scans of each group of `whole`; 0 = none of that class. The draw depends only
/// on seed, class, group and share, so that methods of equal share use the same scans.
Grouping downSampled(const Grouping& whole, const std::vector<std::size_t>& one_of, DownSampling rule,
                     std::uint64_t seed);

}  // namespace fsr::study
