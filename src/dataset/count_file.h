#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dataset/unnamed_file.h"

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

}  // namespace fsr::dataset
