#include "dataset/count_readers.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::dataset {

namespace {

// Not /tmp, which may be memory.
std::string temporaryFolder() {
  const char* const folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/var/tmp";
}

[[noreturn]] void refuse(const std::string& what) {
  throw settings::InputError(temporaryFolder() + ": data of long recordings cannot be " + what + " (" +
                             std::strerror(errno) +
                             "); set TMPDIR to a folder with room for four times the size of all bags");
}

int openUnnamed() {
  std::string name = temporaryFolder() + "/fsr_rows_XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) refuse("kept there");
  ::unlink(name.c_str());
  return file;
}

}  // namespace

UnnamedFile::UnnamedFile() : file_(openUnnamed()) {}

UnnamedFile::~UnnamedFile() {
  ::close(file_);
}

void UnnamedFile::append(const void* bytes, std::size_t size) {
  for (const char* next = static_cast<const char*>(bytes); size > 0;) {
    const ssize_t written = ::write(file_, next, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse("written");
    next += written;
    size -= static_cast<std::size_t>(written);
  }
}

void UnnamedFile::read(void* bytes, std::size_t size, std::size_t offset) const {
  for (char* next = static_cast<char*>(bytes); size > 0;) {
    const ssize_t got = ::pread(file_, next, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) refuse("read again");
    next += got;
    offset += static_cast<std::size_t>(got);
    size -= static_cast<std::size_t>(got);
  }
}

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

bool countsAreWhole(const Recording& recording) {
  const std::size_t taxels = recording.layout.size.taxels();
  if (recording.count_file == nullptr) return recording.counts.size() == recording.scans() * taxels;
  return recording.count_file->scans() == recording.scans() && recording.count_file->taxels() == taxels;
}

bool sameCounts(const Recording& a, const Recording& b) {
  const std::size_t taxels = a.layout.size.taxels();
  if (a.scans() != b.scans() || b.layout.size.taxels() != taxels) return false;
  ScanCounts first(a), second(b);
  for (std::size_t i = 0; i < a.scans(); ++i) {
    const std::uint16_t* const own = first[i];
    if (!std::equal(own, own + taxels, second[i])) return false;
  }
  return true;
}

TaxelCounts::TaxelCounts(const Recording& recording, std::size_t taxel)
    : stride_(recording.layout.size.taxels()), file_(recording.count_file.get()), taxel_(taxel) {
  if (file_ == nullptr)
    memory_ = recording.counts.data() + taxel;
  else
    block_counts_.resize(CountFile::kBlock);
}

void TaxelCounts::load(std::size_t block) {
  file_->readTaxel(block, taxel_, block_counts_.data());
  block_ = block;
}

std::vector<TaxelCounts> taxelCounts(const std::vector<Recording>& recordings, std::size_t taxel) {
  std::vector<TaxelCounts> counts;
  for (const Recording& recording : recordings) counts.emplace_back(recording, taxel);
  return counts;
}

ScanCounts::ScanCounts(const Recording& recording)
    : recording_(&recording), file_(recording.count_file.get()) {
  if (file_ == nullptr) return;
  stored_.resize(file_->taxels() * CountFile::kBlock);
  scans_.resize(stored_.size());
}

void ScanCounts::load(std::size_t block) {
  file_->readBlock(block, stored_.data());
  const std::size_t taxels = file_->taxels();
  for (std::size_t i = 0; i < CountFile::kBlock; ++i) {
    for (std::size_t t = 0; t < taxels; ++t) scans_[i * taxels + t] = stored_[t * CountFile::kBlock + i];
  }
  block_ = block;
}

}  // namespace fsr::dataset
