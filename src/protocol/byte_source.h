#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

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

}  // namespace fsr::protocol
