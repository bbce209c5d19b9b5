#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "dataset/unnamed_file.h"

namespace fsr::study {

/// The held-out errors of each taxel, one after another: in memory, or from 8 MB on in a file.
class ErrorRows {
  static constexpr std::size_t kBlock = 4096;  // errors that are written or read together

 public:
  ErrorRows() = default;
  /// A row of `length` errors for each taxel. Throws InputError as UnnamedFile does.
  ErrorRows(std::size_t taxels, std::size_t length);

  std::size_t taxels() const { return taxels_; }
  std::size_t length() const { return length_; }

  /// Writes the row of one taxel from its start. Rows may be written on several threads. What was added last
  /// is there after finish().
  class Writer {
   public:
    Writer(ErrorRows& rows, std::size_t taxel) : rows_(rows), taxel_(taxel) {}
    void add(float error) {
      block_[filled_++] = error;
      if (filled_ == kBlock) finish();
    }
    void finish();

   private:
    ErrorRows& rows_;
    std::size_t taxel_;
    std::size_t written_ = 0, filled_ = 0;  // errors of the row, of the block
    std::array<float, kBlock> block_{};
  };

  /// Reads the row of one taxel from its start. It belongs to one thread; the rows must outlive it.
  class Reader {
   public:
    Reader(const ErrorRows& rows, std::size_t taxel) : rows_(rows), taxel_(taxel) {}
    float next() {
      if (place_ == filled_) read();
      return block_[place_++];
    }

   private:
    void read();

    const ErrorRows& rows_;
    std::size_t taxel_;
    std::size_t read_ = 0, place_ = 0, filled_ = 0;  // errors of the row that are read; place in the block
    std::array<float, kBlock> block_;
  };

 private:
  // The end of a row is a block of its own in the file, as long as the others.
  struct File {
    dataset::UnnamedFile rows;
    std::mutex writing;
    std::size_t blocks = 0;
    std::vector<std::vector<std::size_t>> block;  // place in the file [taxels][blocks of the row]
  };

  std::size_t taxels_ = 0, length_ = 0;
  std::vector<float> memory_;   // [taxels x length]; empty if in the file
  std::unique_ptr<File> file_;  // null if in memory
};

}  // namespace fsr::study
