#pragma once

#include <cstdint>
#include <vector>

#include "statistics/random_stream.h"

namespace fsr::emulator {

/// What goes wrong between board and computer. The default is a healthy line.
struct LineDamage {
  double lost_bytes = 0;       ///< probability of each byte to vanish, 0 .. 1
  double flipped_bits = 0;     ///< probability of each bit to flip, 0 .. 1
  double lost_packets = 0;     ///< probability of each packet to vanish, 0 .. 1
  double doubled_packets = 0;  ///< probability of each packet to come twice, 0 .. 1
  double noise = 0;            ///< random bytes that follow each byte's worth of packets, 0 .. 100 (ratio)
  double pause = 0;            ///< the line is silent for this long, once, from now on [s rig time]
  bool unplugged = false;      ///< the port is gone
  std::uint32_t baud = 0;      ///< speed at which the board really sends [1/s]; 0 = as it should
};

/// Throws InputError that names what is out of range.
void validate(const LineDamage& damage);

struct LineDamageCounts {
  std::uint64_t lost_packets = 0;
  std::uint64_t doubled_packets = 0;
  std::uint64_t noise_bytes = 0;
  std::uint64_t lost_bytes = 0;
  std::uint64_t flipped_bits = 0;
};

/// Loses and doubles packets, loses bytes and flips bits of what passes, and adds noise behind it; the same
/// seed damages the same bytes.
class LossyLine {
 public:
  explicit LossyLine(std::uint64_t seed) : stream_(statistics::randomStream(seed, "lossy_line")) {}

  /// `packet` becomes what arrives of it, which may be nothing.
  void pass(const LineDamage& damage, std::vector<std::uint8_t>& packet);
  const LineDamageCounts& counts() const { return counts_; }

 private:
  void repeat(const LineDamage& damage, std::vector<std::uint8_t>& packet);
  void damageBytes(const LineDamage& damage, std::vector<std::uint8_t>& bytes);
  void addNoise(std::size_t size, std::vector<std::uint8_t>& bytes);
  bool happens(double probability) { return probability > 0 && stream_.uniform(position_++) < probability; }

  statistics::RandomStream stream_;
  std::uint64_t position_ = 0;
  LineDamageCounts counts_;
};

/// What a UART (8 data bits, no parity, 1 stop bit) at `receiver_baud` makes of `bytes` that were sent
/// back to back at `sender_baud`, the line being idle before and after: it waits for a falling edge and
/// samples the middles of nine more bits of its own length; a wrong stop bit is not looked at, as by
/// default on Linux.
std::vector<std::uint8_t> heardByUart(const std::vector<std::uint8_t>& bytes, std::uint32_t sender_baud,
                                      std::uint32_t receiver_baud);

}  // namespace fsr::emulator
