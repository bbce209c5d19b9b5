#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "emulator/line_damage.h"
#include "emulator/pseudo_terminal.h"

namespace fsr::emulator {

/// Numbers of packets by outcome.
struct LinkCounts {
  std::uint64_t sent = 0;  ///< packets that reached the port, damaged or not
  std::uint64_t unheard =
      0;  ///< packets lost because the port was not open or unplugged, or the line was silent
  std::uint64_t dropped = 0;  ///< packets lost because the reader was too slow
  LineDamageCounts damage;
};

/// The line from the board's pin to the computer's port, with its faults.
class BoardLink {
 public:
  /// `link`: path of a symbolic link to the port, empty = none. `baud`: rate of the board's UART [1/s], 0 =
  /// native USB. Throws InputError.
  BoardLink(const std::string& link, std::uint32_t baud, std::uint64_t seed);

  /// Sets the damage from `time` [s rig time] on. Throws InputError.
  void setDamage(const LineDamage& damage, double time);

  /// Sends a packet and changes it where it is damaged. `patient`: wait for a slow reader, up to half a
  /// second, instead of dropping the packet at once. Returns the time waited.
  std::chrono::steady_clock::duration send(std::vector<std::uint8_t>& packet, double time, bool patient);

  /// Path to open; empty while a port without a link is unplugged.
  std::string port() const { return port_ ? port_->path() : link_; }
  bool hasReader() { return port_ && port_->hasReader(); }
  LinkCounts counts() const;

 private:
  void plugIn();
  void count(PseudoTerminal::Outcome outcome);

  std::string link_;
  std::uint32_t baud_;
  bool reader_keeps_up_ = true;  // otherwise it is not waited for
  LossyLine line_;
  LineDamage damage_;
  double silent_until_ = -std::numeric_limits<double>::infinity();  // [s rig time]
  std::unique_ptr<PseudoTerminal> port_;                            // none = unplugged
  LinkCounts counts_;
};

}  // namespace fsr::emulator
