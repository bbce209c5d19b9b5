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

/// What happened to the packets.
struct LinkCounts {
  std::uint64_t sent = 0;     ///< that reached the port, damaged or not
  std::uint64_t unheard = 0;  ///< nobody had the port open, it was unplugged, or the line was silent
  std::uint64_t dropped = 0;  ///< the reader was too slow
  LineDamageCounts damage;
};

/// From the board's pin to the computer's port: the cable with all that can go wrong on it.
class BoardLink {
 public:
  /// `link`: where a link to the port is put, empty = none. `baud`: of the board's UART [1/s], 0 = native
  /// USB. Throws InputError.
  BoardLink(const std::string& link, std::uint32_t baud, std::uint64_t seed);

  /// Damage from `time` [s rig time] on. Throws InputError.
  void setDamage(const LineDamage& damage, double time);

  /// Sends a packet, changing it where it is damaged. `patient`: waits for a slow reader, up to half a
  /// second, instead of dropping at once. Returns how long it waited.
  std::chrono::steady_clock::duration send(std::vector<std::uint8_t>& packet, double time, bool patient);

  /// What to open; empty while a port without a link is unplugged.
  std::string port() const { return port_ ? port_->path() : link_; }
  bool hasReader() { return port_ && port_->hasReader(); }
  LinkCounts counts() const;

 private:
  void plugIn();
  void count(PseudoTerminal::Outcome outcome);

  std::string link_;
  std::uint32_t baud_;
  bool reader_keeps_up_ = true;  // worth waiting for
  LossyLine line_;
  LineDamage damage_;
  double silent_until_ = -std::numeric_limits<double>::infinity();  // [s rig time]
  std::unique_ptr<PseudoTerminal> port_;                            // none = unplugged
  LinkCounts counts_;
};

}  // namespace fsr::emulator
