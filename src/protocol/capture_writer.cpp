#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "fsr_pressure_map/settings/input_error.h"
#include "protocol/capture.h"

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

}  // namespace fsr::protocol
