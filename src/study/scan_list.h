#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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

}  // namespace fsr::study
