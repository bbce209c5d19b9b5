#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

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

}  // namespace fsr::dataset
