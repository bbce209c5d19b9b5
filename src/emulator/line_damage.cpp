#include "emulator/line_damage.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"

namespace fsr::emulator {

namespace {

constexpr std::size_t kFrame = 10;  // bits: start, eight of data from the lowest on, stop

void require(const char* field, double value, const settings::Range& range) {
  if (range.contains(value)) return;
  std::ostringstream sentence;
  sentence << "damage: " << field << " is " << value << ", but must be " << range.text();
  throw settings::InputError(sentence.str());
}

/// Levels of the line, one for each bit of the sender; high when idle.
class Waveform {
 public:
  explicit Waveform(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  std::size_t bits() const { return bytes_.size() * kFrame; }
  bool high(std::size_t bit) const {
    if (bit >= bits()) return true;
    const std::size_t place = bit % kFrame;
    if (place == 0) return false;
    return place == kFrame - 1 || ((bytes_[bit / kFrame] >> (place - 1)) & 1) != 0;
  }
  /// The first bit from `bit` on that is low and follows a high one; bits() where there is none.
  std::size_t fallingEdge(std::size_t bit) const {
    while (bit < bits() && (high(bit) || (bit > 0 && !high(bit - 1)))) ++bit;
    return bit;
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
};

}  // namespace

void validate(const LineDamage& damage) {
  require("lost_bytes", damage.lost_bytes, {0, 1, ""});
  require("flipped_bits", damage.flipped_bits, {0, 1, ""});
  require("lost_packets", damage.lost_packets, {0, 1, ""});
  require("doubled_packets", damage.doubled_packets, {0, 1, ""});
  require("noise", damage.noise, {0, 100, ""});
  require("pause", damage.pause, {0, 86400, "s"});
  require("baud", damage.baud, {0, 4e6, "1/s"});
}

void LossyLine::pass(const LineDamage& damage, std::vector<std::uint8_t>& packet) {
  const auto noise = static_cast<std::size_t>(damage.noise * static_cast<double>(packet.size()));
  repeat(damage, packet);
  damageBytes(damage, packet);
  addNoise(noise, packet);
}

void LossyLine::repeat(const LineDamage& damage, std::vector<std::uint8_t>& packet) {
  if (happens(damage.lost_packets)) {
    ++counts_.lost_packets;
    packet.clear();
  } else if (happens(damage.doubled_packets)) {
    ++counts_.doubled_packets;
    const std::vector<std::uint8_t> again = packet;
    packet.insert(packet.end(), again.begin(), again.end());
  }
}

void LossyLine::addNoise(std::size_t size, std::vector<std::uint8_t>& bytes) {
  counts_.noise_bytes += size;
  for (std::size_t i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(256 * stream_.uniform(position_++)));
  }
}

void LossyLine::damageBytes(const LineDamage& damage, std::vector<std::uint8_t>& bytes) {
  std::size_t kept = 0;
  for (std::uint8_t byte : bytes) {
    if (happens(damage.lost_bytes)) {
      ++counts_.lost_bytes;
      continue;
    }
    for (int bit = 0; bit < 8; ++bit) {
      if (!happens(damage.flipped_bits)) continue;
      byte = static_cast<std::uint8_t>(byte ^ (1 << bit));
      ++counts_.flipped_bits;
    }
    bytes[kept++] = byte;
  }
  bytes.resize(kept);
}

std::vector<std::uint8_t> heardByUart(const std::vector<std::uint8_t>& bytes, std::uint32_t sender_baud,
                                      std::uint32_t receiver_baud) {
  if (sender_baud == receiver_baud || sender_baud == 0 || receiver_baud == 0) return bytes;
  const double bit_length = static_cast<double>(sender_baud) / receiver_baud;  // [sender's bits]
  const Waveform line(bytes);
  std::vector<std::uint8_t> heard;
  for (std::size_t edge = line.fallingEdge(0); edge < line.bits();) {
    const auto sampled = [&](std::size_t bit) {
      return static_cast<std::size_t>(static_cast<double>(edge) +
                                      (static_cast<double>(bit) + 0.5) * bit_length);
    };
    // A start bit that is no longer low in its middle is treated as a spike.
    if (line.high(sampled(0))) {
      edge = line.fallingEdge(edge + 1);
      continue;
    }
    unsigned byte = 0;
    for (std::size_t bit = 0; bit < 8; ++bit) byte |= line.high(sampled(bit + 1)) ? 1u << bit : 0u;
    heard.push_back(static_cast<std::uint8_t>(byte));
    edge = line.fallingEdge(
        std::max(sampled(kFrame - 1), edge + 1));  // the frame of a fast receiver ends within this bit
  }
  return heard;
}

}  // namespace fsr::emulator
