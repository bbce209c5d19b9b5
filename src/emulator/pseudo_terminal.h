#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fsr::emulator {

/// The board's end of a serial line. Any program can open the other end like a serial port. It exists as long
/// as the object; destroying the object is like unplugging.
///
/// Like a UART it sends whether a reader has the port open or not, and it never waits without limit. A reader
/// receives no bytes from before it opened the port.
class PseudoTerminal {
 public:
  enum class Outcome {
    kSent,
    kUnheard,  ///< no reader has the port open
    kFull,     ///< the reader is too slow: the whole packet was dropped
  };

  /// `link`: path of a symbolic link to the port, empty = none. An old link there is replaced.
  /// `baud`: rate of the port until a reader sets another [1/s]. Throws InputError.
  PseudoTerminal(const std::string& link, std::uint32_t baud);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Path to open: the link if there is one.
  const std::string& path() const { return link_.empty() ? slave_ : link_; }

  /// Sends the whole packet or nothing.
  Outcome write(const std::uint8_t* packet, std::size_t size);

  /// Waits until there is room to write; false after `timeout`.
  bool waitForRoom(std::chrono::milliseconds timeout);

  bool hasReader();

  /// Rate that the reader has set [1/s].
  std::uint32_t readerBaud() const;

 private:
  bool flushRest();
  void discardInput();
  void discardUnread();

  std::string link_;
  std::string slave_;  // /dev/pts/N
  int master_ = -1;
  bool had_reader_ = false;
  std::vector<std::uint8_t> rest_;  // rest of a packet that was sent in part
};

}  // namespace fsr::emulator
