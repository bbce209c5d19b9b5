#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dataset/count_file.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// Whether a recording has counts of `scans()` scans, in memory or in a file.
bool countsAreWhole(const Recording& recording);

/// Whether two recordings have the same counts.
bool sameCounts(const Recording& a, const Recording& b);

/// The counts of one taxel of a recording, wherever they are. Made for scans in ascending order; any other
/// order works, too. The recording must outlive the object, which belongs to one thread.
class TaxelCounts {
 public:
  TaxelCounts(const Recording& recording, std::size_t taxel);

  std::uint16_t operator[](std::size_t scan) {
    if (memory_ != nullptr) return memory_[scan * stride_];
    const std::size_t block = scan / CountFile::kBlock;
    if (block != block_) load(block);
    return block_counts_[scan % CountFile::kBlock];
  }

 private:
  void load(std::size_t block);

  const std::uint16_t* memory_ = nullptr;
  std::size_t stride_ = 0;
  const CountFile* file_ = nullptr;
  std::size_t taxel_ = 0;
  std::size_t block_ = static_cast<std::size_t>(-1);
  std::vector<std::uint16_t> block_counts_;  // [kBlock]
};

/// Of one taxel in each recording.
std::vector<TaxelCounts> taxelCounts(const std::vector<Recording>& recordings, std::size_t taxel);

/// The scans of a recording, wherever they are. Otherwise as TaxelCounts.
class ScanCounts {
 public:
  explicit ScanCounts(const Recording& recording);

  /// The counts of all taxels, valid until the next call.
  const std::uint16_t* operator[](std::size_t scan) {
    if (file_ == nullptr) return recording_->scan(scan);
    const std::size_t block = scan / CountFile::kBlock;
    if (block != block_) load(block);
    return scans_.data() + (scan % CountFile::kBlock) * file_->taxels();
  }

 private:
  void load(std::size_t block);

  const Recording* recording_;
  const CountFile* file_;
  std::size_t block_ = static_cast<std::size_t>(-1);
  std::vector<std::uint16_t> stored_, scans_;  // [taxels x kBlock], [kBlock x taxels]
};

}  // namespace fsr::dataset
