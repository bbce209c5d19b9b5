#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fsr::emulator {

/// The board's end of a serial line whose other end any program can open like a serial port. It exists
/// as long as the object; destroying it is pulling the plug.
///
/// Like a UART it sends whether anybody listens or not, never waits for ever, and a listener finds no
/// bytes from before it opened the port.
class PseudoTerminal {
 public:
  enum class Outcome {
    kSent,
    kUnheard,  ///< nobody has the port open
    kFull,     ///< the reader is behind: the packet was dropped as a whole
  };

  /// `link`: where a symbolic link to the port is put, empty = none; an old link there is replaced.
  /// `baud`: the port's speed until a reader sets another [1/s]. Throws InputError.
  PseudoTerminal(const std::string& link, std::uint32_t baud);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// What to open: the link where there is one.
  const std::string& path() const { return link_.empty() ? slave_ : link_; }

  /// Sends a packet whole, or not at all.
  Outcome write(const std::uint8_t* packet, std::size_t size);

  /// Waits until there is room to write; false where there was none in time.
  bool waitForRoom(std::chrono::milliseconds timeout);

  bool hasReader();

  /// Speed that the reader has set [1/s].
  std::uint32_t readerBaud() const;

 private:
  bool flushRest();
  void discardInput();
  void discardUnread();

  std::string link_;
  std::string slave_;  // /dev/pts/N
  int master_ = -1;
  bool had_reader_ = false;
  std::vector<std::uint8_t> rest_;  // of a packet that went out in part
};

}  // namespace fsr::emulator
