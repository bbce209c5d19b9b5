#include "dataset/count_file.h"

#include <algorithm>

namespace fsr::dataset {

CountFile::CountFile(std::size_t taxels) : taxels_(taxels), open_(taxels * kBlock, std::uint16_t{0}) {}

void CountFile::add(const std::uint16_t* scan) {
  const std::size_t place = scans_ % kBlock;
  for (std::size_t taxel = 0; taxel < taxels_; ++taxel) open_[taxel * kBlock + place] = scan[taxel];
  if (++scans_ % kBlock == 0) writeBlock();
}

void CountFile::writeBlock() {
  file_.append(open_.data(), open_.size() * sizeof(std::uint16_t));
  std::fill(open_.begin(), open_.end(), std::uint16_t{0});
}

void CountFile::finish() {
  if (scans_ % kBlock != 0) writeBlock();
  open_ = {};
}

void CountFile::readTaxel(std::size_t block, std::size_t taxel, std::uint16_t* counts) const {
  constexpr std::size_t kBytes = kBlock * sizeof(std::uint16_t);
  file_.read(counts, kBytes, (block * taxels_ + taxel) * kBytes);
}

void CountFile::readBlock(std::size_t block, std::uint16_t* counts) const {
  const std::size_t bytes = taxels_ * kBlock * sizeof(std::uint16_t);
  file_.read(counts, bytes, block * bytes);
}

}  // namespace fsr::dataset
