#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/byte_source.h"

namespace fsr::protocol {

/// A serial port in raw mode (8 data bits, no parity, 1 stop bit, no flow control), opened exclusively.
class SerialPort : public ByteSource {
 public:
  /// `baud` [1/s] may be any rate that the hardware supports. 0 leaves the port's speed unchanged, for boards
  /// with native USB, which has its own speed. Throws LinkError with a sentence that says what to do: which
  /// ports exist, which group the user must join, or that another program has the port open.
  SerialPort(const std::string& path, std::uint32_t baud, HostClock now);
  ~SerialPort() override;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  Chunk read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) override;
  /// As given to the constructor; 0 for a pseudo-terminal, whose speed has no meaning.
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
