#include "protocol/capture.h"

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/regular_file.h"

namespace fsr::protocol {
namespace {

void put(std::uint8_t* at, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::string openComplaint(const std::string& path) {
  if (errno == EEXIST) return "capture " + path + " exists already and is not overwritten: name another file";
  return "capture " + path + " cannot be written (" + std::strerror(errno) +
         "): name a file in a folder that exists and may be written to";
}

}  // namespace

CaptureWriter::CaptureWriter(const std::string& path) : path_(path) {
  descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw settings::InputError(openComplaint(path));
  std::array<std::uint8_t, capture::kFileHeader> header{};
  std::memcpy(header.data(), capture::kMagic, 8);
  if (::write(descriptor_, header.data(), header.size()) == static_cast<ssize_t>(header.size())) return;
  close(descriptor_);
  throw settings::InputError(openComplaint(path));
}

CaptureWriter::~CaptureWriter() {
  close(descriptor_);
}

void CaptureWriter::noteBaud(std::uint32_t baud) {
  std::array<std::uint8_t, 4> bytes;
  put(bytes.data(), baud, 4);
  check(pwrite(descriptor_, bytes.data(), bytes.size(), 8), bytes.size());
}

void CaptureWriter::write(const std::uint8_t* bytes, std::size_t size, std::int64_t receive_time) {
  std::array<std::uint8_t, capture::kChunkHeader> header;
  put(header.data(), static_cast<std::uint64_t>(receive_time), 8);
  put(header.data() + 8, size, 4);
  const std::array<iovec, 2> parts = {iovec{header.data(), header.size()},
                                      iovec{const_cast<std::uint8_t*>(bytes), size}};
  check(writev(descriptor_, parts.data(), parts.size()), header.size() + size);
}

void CaptureWriter::check(std::int64_t written, std::size_t size) const {
  if (written == static_cast<std::int64_t>(size)) return;
  if (written >= 0) errno = ENOSPC;  // only a part was written
  throw LinkError("capture " + path_ + " cannot be continued (" + std::strerror(errno) +
                  "): what was written so far can be used");
}

namespace {

std::uint64_t get(const std::uint8_t* at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
  return value;
}

// Returns the number of bytes read, up to `size`.
std::size_t readUpTo(std::ifstream& file, std::uint8_t* bytes, std::size_t size) {
  file.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(size));
  return static_cast<std::size_t>(file.gcount());
}

}  // namespace

CaptureReader::CaptureReader(const std::string& path) : path_(path) {
  settings::requireRegularFile(path);
  file_.open(path, std::ios::binary);
  std::array<std::uint8_t, capture::kFileHeader> header{};
  const std::size_t size = readUpTo(file_, header.data(), header.size());
  if (size < header.size() || std::memcmp(header.data(), capture::kMagic, 8) != 0) {
    throw settings::InputError("capture " + path + " does not start with " + capture::kMagic +
                               ": name a file that the driver's capture_file wrote");
  }
  baud_ = static_cast<std::uint32_t>(get(header.data() + 8, 4));
  offset_ = header.size();
}

Chunk CaptureReader::read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds /*timeout*/) {
  if (delivered_ == chunk_.size() && !nextChunk()) return {};
  const std::size_t size = std::min(capacity, chunk_.size() - delivered_);
  std::memcpy(buffer, chunk_.data() + delivered_, size);
  delivered_ += size;
  return {size, receive_time_};
}

// False at the end of the file, or at the place where it is damaged.
bool CaptureReader::nextChunk() {
  delivered_ = 0;
  chunk_.clear();
  if (ended_) return false;
  std::array<std::uint8_t, capture::kChunkHeader> header{};
  const std::size_t got = readUpTo(file_, header.data(), header.size());
  const std::size_t size = get(header.data() + 8, 4);
  const bool sane = got == header.size() && size >= 1 && size <= capture::kMaxChunk;
  if (sane) {
    chunk_.resize(size);
    chunk_.resize(readUpTo(file_, chunk_.data(), size));
  }
  ended_ = !sane || chunk_.size() < size;
  if (ended_ && got > 0) {
    damage_ = "capture " + path_ + (got < header.size() || sane ? " is cut short" : " is damaged") +
              " at byte " + std::to_string(offset_) + ": replayed up to there";
  }
  receive_time_ = static_cast<std::int64_t>(get(header.data(), 8));
  offset_ += header.size() + chunk_.size();
  return !chunk_.empty();
}

PacedSource::PacedSource(std::unique_ptr<ByteSource> source, HostClock now)
    : source_(std::move(source)), now_(std::move(now)), buffer_(capture::kMaxChunk) {}

Chunk PacedSource::read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) {
  if (given_ == held_.size) {
    given_ = 0;
    held_ = source_->read(buffer_.data(), buffer_.size(), timeout);
    if (held_.size == 0) return {};
    if (!std::exchange(started_, true)) shift_ = now_() - held_.receive_time;
    held_.receive_time += shift_;
  }
  if (!due(timeout)) return {};
  const std::size_t size = std::min(capacity, held_.size - given_);
  std::memcpy(buffer, buffer_.data() + given_, size);
  given_ += size;
  return {size, held_.receive_time};
}

// Sleeps in short steps, because the clock may run faster than the host's.
bool PacedSource::due(std::chrono::milliseconds timeout) const {
  constexpr std::chrono::nanoseconds kStep = std::chrono::milliseconds(5);
  const auto give_up = std::chrono::steady_clock::now() + timeout;
  while (now_() < held_.receive_time) {
    if (std::chrono::steady_clock::now() >= give_up) return false;
    std::this_thread::sleep_for(std::min(kStep, std::chrono::nanoseconds(held_.receive_time - now_())));
  }
  return true;
}

}  // namespace fsr::protocol
