#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "protocol/serial_port.h"

namespace fsr::protocol {

/// A capture file stores the raw bytes of a link with their receive times. A replay goes through the same
/// decoder and the same clock filter as the live bytes did. The file, little endian:
///
///     offset  bytes
///          0      8  "FSRCAP01"
///          8      4  baud of the line [1/s]; 0 = none
///         12      4  reserved, 0
///     then for each chunk of bytes that were received together:
///          0      8  receive time, signed [ns]
///          8      4  number n of bytes, 1 to 65,536
///         12      n  the bytes
namespace capture {
constexpr char kMagic[] = "FSRCAP01";
constexpr std::size_t kFileHeader = 16;
constexpr std::size_t kChunkHeader = 12;
constexpr std::size_t kMaxChunk = 65536;
}  // namespace capture

/// Writes a capture. Each chunk is written with one system call, so that a killed process leaves at most its
/// last chunk incomplete.
class CaptureWriter {
 public:
  /// Throws InputError where the file cannot be created or exists already.
  explicit CaptureWriter(const std::string& path);
  ~CaptureWriter();
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;

  /// Writes the baud of the line [1/s] to the file's header. Throws LinkError.
  void noteBaud(std::uint32_t baud);

  /// `size` is 1 to kMaxChunk [bytes], `receive_time` [ns]. Throws LinkError, e.g. where the disk is full.
  void write(const std::uint8_t* bytes, std::size_t size, std::int64_t receive_time);

 private:
  void check(std::int64_t written, std::size_t size) const;

  std::string path_;
  int descriptor_ = -1;
};

/// Reads a capture without waiting, with the receive times of the file.
class CaptureReader : public ByteSource {
 public:
  /// Throws InputError where the file cannot be read or is no capture.
  explicit CaptureReader(const std::string& path);

  Chunk read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) override;
  std::uint32_t baud() const override { return baud_; }
  bool ended() const override { return ended_; }

  /// Where and how the file is incomplete or damaged. Everything before that place was delivered.
  std::string remark() const override { return damage_; }

 private:
  bool nextChunk();

  std::string path_;
  std::ifstream file_;
  std::uint64_t offset_ = 0;  // in the file [bytes]
  std::uint32_t baud_ = 0;
  std::vector<std::uint8_t> chunk_;
  std::size_t delivered_ = 0;  // of chunk_
  std::int64_t receive_time_ = 0;
  bool ended_ = false;
  std::string damage_;
};

/// Delivers the bytes of another source at the pace of a clock, with the same intervals as their receive
/// times. The receive times are shifted so that the first bytes come now.
class PacedSource : public ByteSource {
 public:
  PacedSource(std::unique_ptr<ByteSource> source, HostClock now);

  Chunk read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) override;
  std::uint32_t baud() const override { return source_->baud(); }
  bool ended() const override { return given_ == held_.size && source_->ended(); }
  std::string remark() const override { return source_->remark(); }

 private:
  bool due(std::chrono::milliseconds timeout) const;

  std::unique_ptr<ByteSource> source_;
  HostClock now_;
  std::vector<std::uint8_t> buffer_;
  Chunk held_;             // in buffer_
  std::size_t given_ = 0;  // of held_ [bytes]
  bool started_ = false;
  std::int64_t shift_ = 0;  // from the source's times to the clock's [ns]
};

}  // namespace fsr::protocol
