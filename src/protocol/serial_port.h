#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace fsr::protocol {

/// The host's time [ns] on the caller's clock; in a ROS node the ROS time, real or simulated.
using HostClock = std::function<std::int64_t()>;

/// A link that cannot be opened or is broken. what() is one sentence that says what to do. Trying again later
/// may help.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes that were received together.
struct Chunk {
  std::size_t size = 0;           ///< [bytes]; 0 = none were received
  std::int64_t receive_time = 0;  ///< arrival of the last of them, host time [ns]
};

/// Source of a board's bytes: a serial port or a capture file.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Waits up to `timeout` for bytes and writes at most `capacity` of them to `buffer`. Throws LinkError
  /// where the link is broken.
  virtual Chunk read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) = 0;

  /// Bit rate of the line [1/s]; 0 = the time of the bytes is negligible (native USB, pseudo-terminal).
  virtual std::uint32_t baud() const = 0;

  /// True when no more bytes can come: at the end of a capture.
  virtual bool ended() const { return false; }

  /// One sentence on a source that ended, e.g. that its file is damaged; empty = none.
  virtual std::string remark() const { return ""; }
};

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
