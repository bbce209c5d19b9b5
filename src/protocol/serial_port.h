#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/byte_source.h"

namespace fsr::protocol {

/// A serial port in raw mode (8 data bits, no parity, 1 stop bit, no flow control), opened for this
/// process alone.
class SerialPort : public ByteSource {
 public:
  /// `baud` [1/s] may be any rate that the hardware can make; 0 leaves the port's speed alone, for boards
  /// with native USB, whose bytes travel at USB's own speed. Throws LinkError with a sentence that says
  /// what to do: which ports are there, whose group the user must join, which program holds the port.
  SerialPort(const std::string& path, std::uint32_t baud, HostClock now);
  ~SerialPort() override;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  Chunk read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) override;
  /// As given; 0 for a pseudo-terminal, which has a speed in name only.
  std::uint32_t baud() const override { return baud_; }

 private:
  void configure(std::uint32_t baud);
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  int descriptor_ = -1;
  std::uint32_t baud_ = 0;
  HostClock now_;
};

/// Serial ports under `dev`: stable names (serial/by-id/*) first, then ttyACM* and ttyUSB*, sorted.
std::vector<std::string> serialPortCandidates(const std::string& dev = "/dev");

/// Why `path` did not open with `error` (an errno) and what to do about it, in one sentence.
std::string explainOpenError(const std::string& path, int error);

}  // namespace fsr::protocol
