#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// A temporary file without a name, for what of long recordings is too much for the memory. It lies in
/// TMPDIR (else /var/tmp) and is gone with the object or the process.
class UnnamedFile {
 public:
  /// All members throw InputError where the folder cannot be written or the disk is full.
  UnnamedFile();
  ~UnnamedFile();
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;

  void append(const void* bytes, std::size_t size);
  /// From any thread. There must be `size` bytes at `offset`.
  void read(void* bytes, std::size_t size, std::size_t offset) const;

 private:
  int file_;
};

/// Rows of values that are written once and read in their order: in memory, or from `most` bytes on in a
/// file.
template <typename T>
class RowSpool {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

  /// `most` [bytes].
  explicit RowSpool(std::size_t most) : most_(most) {}

  /// Rows of so many values, 1 or more. Before the first row; so many rows are expected.
  void begin(std::size_t values, std::uint64_t rows) {
    values_ = values;
    const std::uint64_t fit = most_ / (sizeof(T) * values) + 1;
    memory_.reserve(std::min(rows, fit) * values);
  }
  void add(const T* row) {
    memory_.insert(memory_.end(), row, row + values_);
    ++rows_;
    if (memory_.size() * sizeof(T) > most_) flush();
  }

  std::size_t most() const { return most_; }
  std::size_t rows() const { return rows_; }
  bool inFile() const { return file_ != nullptr; }
  /// [rows x values]. The rows must not be in a file.
  std::vector<T>& memory() { return memory_; }

  /// Made for ascending rows; any order works, too. The spool must outlive it and stay as it is. It belongs
  /// to one thread.
  class Reader {
   public:
    explicit Reader(const RowSpool& spool) : spool_(&spool) {}

    /// The values of a row, valid until the next call.
    const T* operator[](std::size_t row) {
      if (row >= spool_->written_) return spool_->memory_.data() + (row - spool_->written_) * spool_->values_;
      if (row < begin_ || row >= end_) read(row);
      return window_.data() + (row - begin_) * spool_->values_;
    }

   private:
    static constexpr std::size_t kWindow = 1024;  // rows

    void read(std::size_t row) {
      const std::size_t values = spool_->values_;
      begin_ = row / kWindow * kWindow;
      end_ = std::min(begin_ + kWindow, spool_->written_);
      window_.resize((end_ - begin_) * values);
      spool_->file_->read(window_.data(), window_.size() * sizeof(T), begin_ * values * sizeof(T));
    }

    const RowSpool* spool_;
    std::vector<T> window_;
    std::size_t begin_ = 0, end_ = 0;  // rows of the window
  };

 private:
  void flush() {
    if (file_ == nullptr) file_ = std::make_unique<UnnamedFile>();
    file_->append(memory_.data(), memory_.size() * sizeof(T));
    memory_.clear();
    written_ = rows_;
  }

  std::size_t most_;
  std::size_t values_ = 1, rows_ = 0;
  std::vector<T> memory_;  // all rows, or those that are not in the file yet
  std::unique_ptr<UnnamedFile> file_;
  std::size_t written_ = 0;  // rows in the file
};

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
