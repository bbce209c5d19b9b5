#pragma once

#include <cstdint>
#include <vector>

#include "statistics/random_stream.h"

namespace fsr::emulator {

/// Faults of the line between board and computer. The default is a line without faults.
struct LineDamage {
  double lost_bytes = 0;       ///< probability that a byte is lost, 0 .. 1
  double flipped_bits = 0;     ///< probability that a bit is flipped, 0 .. 1
  double lost_packets = 0;     ///< probability that a packet is lost, 0 .. 1
  double doubled_packets = 0;  ///< probability that a packet is sent twice, 0 .. 1
  double noise = 0;            ///< random bytes added per byte of packets, 0 .. 100 (ratio)
  double pause = 0;            ///< the line is silent for this long from now on, once [s rig time]
  bool unplugged = false;      ///< the port does not exist
  std::uint32_t baud = 0;      ///< rate at which the board sends [1/s]; 0 = the right one
};

/// Throws InputError, which names the field that is out of range.
void validate(const LineDamage& damage);

struct LineDamageCounts {
  std::uint64_t lost_packets = 0;
  std::uint64_t doubled_packets = 0;
  std::uint64_t noise_bytes = 0;
  std::uint64_t lost_bytes = 0;
  std::uint64_t flipped_bits = 0;
};

/// Loses and doubles packets, loses bytes, flips bits and adds noise. The same seed damages the same bytes.
class LossyLine {
 public:
  explicit LossyLine(std::uint64_t seed) : stream_(statistics::randomStream(seed, "lossy_line")) {}

  /// Replaces `packet` by the bytes that arrive, which may be none.
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

/// The bytes that a UART (8 data bits, no parity, 1 stop bit) at `receiver_baud` receives where `bytes` were
/// sent back to back at `sender_baud` on a line that is idle before and after. The UART waits for a falling
/// edge and samples the middles of nine more bits of its own length. A wrong stop bit is ignored, as by
/// default on Linux.
std::vector<std::uint8_t> heardByUart(const std::vector<std::uint8_t>& bytes, std::uint32_t sender_baud,
                                      std::uint32_t receiver_baud);

}  // namespace fsr::emulator
