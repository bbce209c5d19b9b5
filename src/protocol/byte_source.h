#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace fsr::protocol {

/// The host's time [ns], as the caller counts it: in a ROS node the ROS time, real or simulated.
using HostClock = std::function<std::int64_t()>;

/// A link that cannot be opened or broke. what() is one sentence that says what to do; trying again
/// later may help.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes that came together.
struct Chunk {
  std::size_t size = 0;           ///< [bytes]; 0 = none came
  std::int64_t receive_time = 0;  ///< when the last of them was here, host time [ns]
};

/// Where a board's bytes come from: a serial port, or a file that captured one.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Waits up to `timeout` for bytes and puts at most `capacity` of them into `buffer`. Throws LinkError
  /// where the link broke.
  virtual Chunk read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) = 0;

  /// Bits per second of the line [1/s]; 0 = bytes take no time to speak of (native USB, pseudo-terminal).
  virtual std::uint32_t baud() const = 0;

  /// True when no byte can come any more: a capture at its end.
  virtual bool ended() const { return false; }

  /// What the user should know about a source that ended, one sentence; empty = nothing.
  virtual std::string remark() const { return ""; }
};

}  // namespace fsr::protocol
