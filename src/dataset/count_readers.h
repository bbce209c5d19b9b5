#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dataset/unnamed_file.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// The counts of the scans of a recording in a temporary file without a name, taxel by taxel in blocks of
/// kBlock scans, so that work on one taxel reads its own counts only. Neither writing nor reading needs
/// memory that grows with the recording.
class CountFile {
 public:
  static constexpr std::size_t kBlock = 2048;  // scans: a page of counts for each taxel

  /// All members throw InputError as UnnamedFile does.
  explicit CountFile(std::size_t taxels);

  /// Appends a scan of `taxels` counts.
  void add(const std::uint16_t* scan);
  /// Writes the last scans. None can be added afterwards.
  void finish();

  std::size_t taxels() const { return taxels_; }
  std::size_t scans() const { return scans_; }

  /// After finish(), from any thread. The counts of one taxel in a block, kBlock of them; those beyond the
  /// last scan are 0.
  void readTaxel(std::size_t block, std::size_t taxel, std::uint16_t* counts) const;
  /// All counts of a block, [taxels x kBlock].
  void readBlock(std::size_t block, std::uint16_t* counts) const;

 private:
  void writeBlock();

  std::size_t taxels_;
  std::size_t scans_ = 0;
  UnnamedFile file_;
  std::vector<std::uint16_t> open_;  // the block that is being filled, [taxels x kBlock]
};

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
