#include "study/error_rows.h"

#include <algorithm>

namespace fsr::study {

namespace {

constexpr std::size_t kMostRows = 8u << 20;  // of all rows [bytes]

}  // namespace

ErrorRows::ErrorRows(std::size_t taxels, std::size_t length) : taxels_(taxels), length_(length) {
  if (taxels * length * sizeof(float) <= kMostRows) {
    memory_.resize(taxels * length);
    return;
  }
  file_ = std::make_unique<File>();
  file_->block.resize(taxels);
}

void ErrorRows::Writer::finish() {
  if (filled_ == 0) return;
  if (rows_.file_ == nullptr) {
    std::copy_n(block_.begin(), filled_,
                rows_.memory_.begin() + static_cast<std::ptrdiff_t>(taxel_ * rows_.length_ + written_));
  } else {
    File& file = *rows_.file_;
    const std::lock_guard<std::mutex> lock(file.writing);
    file.rows.append(block_.data(), sizeof block_);
    file.block[taxel_].push_back(file.blocks++);
  }
  written_ += filled_;
  filled_ = 0;
}

void ErrorRows::Reader::read() {
  filled_ = std::min(kBlock, rows_.length_ - read_);
  if (rows_.file_ == nullptr) {
    std::copy_n(rows_.memory_.begin() + static_cast<std::ptrdiff_t>(taxel_ * rows_.length_ + read_), filled_,
                block_.begin());
  } else {
    const File& file = *rows_.file_;
    file.rows.read(block_.data(), sizeof block_, file.block[taxel_][read_ / kBlock] * sizeof block_);
  }
  read_ += filled_;
  place_ = 0;
}

}  // namespace fsr::study
